"""Estimators that answer from a script: for tests, `caretree check` and the fault campaign."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ...perception.estimates import Estimate
from ...sim.world import Frame
from ..core.context import Estimator, Perception


def scripted_perception(answers: Mapping[str, Any]) -> Perception:
    """Estimators by name.

    Args:
        answers: name -> an Estimate, an exception to raise, a function `(frame, **details)` that gives one of
            these, or a list of them: one for each time it is asked, the last for ever after.

    Returns:
        Estimators whose answers carry the stamp of the frame they were asked about.

    Example:
        scripted_perception({"hang_point": point, "gown_side": [inside, outside],
                             "arm": PerceptionFailure(Problem.ARM_LOST, "the left arm")})
    """
    return Perception({name: _estimator(answer) for name, answer in answers.items()})


def _estimator(script: Any) -> Estimator:
    answers = list(script) if isinstance(script, list) else [script]
    if not answers:
        raise ValueError("a scripted estimator needs at least one answer")
    asked = 0

    def estimate(frame: Frame, **details: Any) -> Estimate:
        nonlocal asked
        answer = answers[min(asked, len(answers) - 1)]
        asked += 1
        if callable(answer) and not isinstance(answer, type):
            answer = answer(frame, **details)
        if isinstance(answer, BaseException):
            raise answer
        if not isinstance(answer, Estimate):
            raise TypeError(f"a scripted estimator answers with an Estimate, not {type(answer).__name__}")
        return replace(answer, stamp=frame.stamp)

    return estimate
