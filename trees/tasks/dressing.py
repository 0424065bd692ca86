"""Dress a person who cannot move their arms in a back-opening hospital gown, from the rail to the bed."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ...perception.estimators import classical_estimators
from ...sim.errors import CaretreeError
from ...skills.context import Context
from ..composers import sequence
from ..decorators import FailSafe
from ..dressing import dress, make_safe, spread, take_down, unfold

STAGES = {"A": take_down, "B": unfold, "C": dress, "D": spread}


def build(context: Context, stage: str = "") -> Behaviour:
    """All stages, or `stage` alone.

    Raises:
        CaretreeError: no such stage.
    """
    if stage and stage not in STAGES:
        raise CaretreeError(f"the dressing task has no stage {stage!r}; it has {', '.join(STAGES)}")
    for name, estimator in classical_estimators(context.world.room, context.seed).items():
        context.perception.offer(name, estimator)
    stages = [make(context) for letter, make in STAGES.items() if stage in ("", letter)]
    return FailSafe("dress safely", sequence("dressing", *stages), make_safe(context))
