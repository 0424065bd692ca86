"""Every failure is told, and which one decided."""

from __future__ import annotations

import numpy as np
from caretree.trees.report.looks import Look
from caretree.trees.report.timeline import Span
from caretree.trees.report.why import decisive, failed_attempts, look_at, sentence_of


def span(name, t, reason="NOTHING_SEEN", status="FAILURE", detail=""):
    return Span(path=f"all/{name}", t_start=t - 1, t_end=t, status=status, reason=reason, detail=detail, label=name)


STAGES = [{"name": "lay", "t_start": 0.0, "t_end": 5.0}, {"name": "dress", "t_start": 5.0, "t_end": None}]
SPANS = [
    span("look", 2.0),
    span("look", 3.0),
    span("pull", 4.0, "SLEEVE_CAUGHT"),
    span("lift", 4.5, "", "SUCCESS"),
    span("asks", 4.6, ""),
    span("look", 6.0),
]


def test_failures_alike_on_end_are_one():
    attempts = failed_attempts(SPANS, STAGES)
    assert [(each.span.name, each.times, each.stage) for each in attempts] == [
        ("look", (2.0, 3.0), "lay"),
        ("pull", (4.0,), "lay"),
        ("look", (6.0,), "dress"),
    ]
    assert attempts[0].sentence == "The camera does not show what was looked for."
    assert sentence_of("OLD_REASON") == "OLD_REASON"


def test_the_failure_that_the_outcome_names_decides():
    attempts = failed_attempts(SPANS, STAGES)

    def of(outcome, reason):
        found = decisive({"outcome": outcome, "reason": reason}, attempts)
        return found and (found.span.name, found.times[-1])

    assert of("failure", "The sleeve is caught. [pull] at the elbow") == ("pull", 4.0)
    assert of("failure", "It failed. [look]") == ("look", 6.0)
    assert of("safe_stop", "The operator interrupted the run. [operator]") is None
    assert of(None, None) == ("look", 6.0), "cut short: the last one known"
    assert of("success", "The task is done.") is None


def test_a_look_belongs_to_its_failure():
    attempts = failed_attempts(SPANS, STAGES)
    looks = [
        Look(t, "head", np.zeros((2, 2, 3), np.uint8), node=node) for t, node in ((3.0, "all/look"), (4.0, "all/x"))
    ]
    assert look_at(attempts[0], looks) is looks[0]
    assert look_at(attempts[1], looks) is None
    assert look_at(attempts[2], looks) is None
