"""Why a run went as it did: every failed attempt with its reason, and the failure that decided with what was seen."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ...skills.core.reasons import Reason
from .looks import Look
from .timeline import Span

NEAR = 0.5  # [s] a picture that belongs to a failure was kept so near to it


@dataclass(frozen=True)
class Attempt:
    """Something that failed, once or several times with the same reason on end.

    Attributes:
        span: the first time.
        times: when it failed each time [s].
        stage: of the task in which it did.
    """

    span: Span
    times: tuple[float, ...]
    stage: str

    @property
    def sentence(self) -> str:
        """Why, as the operator reads it."""
        return sentence_of(self.span.reason)


def sentence_of(reason: str) -> str:
    """The sentence of a reason by its name in the trace."""
    return Reason[reason].value if reason in Reason.__members__ else reason


def failed_attempts(spans: Sequence[Span], stages: Sequence[Mapping[str, Any]]) -> list[Attempt]:
    """Every failure that carries a reason, in order; alike ones that follow each other are one."""
    attempts: list[Attempt] = []
    for span in sorted((span for span in spans if span.status == "FAILURE" and span.reason), key=lambda s: s.t_end):
        last = attempts[-1] if attempts else None
        if last is not None and _alike(last.span, span):
            attempts[-1] = Attempt(last.span, (*last.times, span.t_end), last.stage)
        else:
            attempts.append(Attempt(span, (span.t_end,), _stage_of(span.t_end, stages)))
    return attempts


def _alike(one: Span, other: Span) -> bool:
    return (one.path, one.reason, one.detail) == (other.path, other.reason, other.detail)


def _stage_of(t: float, stages: Sequence[Mapping[str, Any]]) -> str:
    for stage in stages:
        first, last = stage.get("t_start"), stage.get("t_end")
        if isinstance(first, (int, float)) and first <= t and (not isinstance(last, (int, float)) or t <= last):
            return str(stage.get("name"))
    return ""


def decisive(run: Mapping[str, Any], attempts: Sequence[Attempt]) -> Attempt | None:
    """The failure that ended the run: the last one of the node that its reason names; None where it names none."""
    if run.get("outcome") == "success" or not attempts:
        return None
    named = re.search(r"\[(.*?)\]", str(run.get("reason") or ""))
    mine = [attempt for attempt in attempts if named is None or attempt.span.name == named[1]]
    return max(mine, key=lambda attempt: attempt.times[-1], default=None)


def look_at(attempt: Attempt, looks: Sequence[Look]) -> Look | None:
    """What was seen before the last time that it failed."""
    mine = [each for each in looks if each.node == attempt.span.path and abs(each.t - attempt.times[-1]) < NEAR]
    return mine[-1] if mine else None
