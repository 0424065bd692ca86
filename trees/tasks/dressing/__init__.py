"""Dress a person who cannot move their arms in a back-opening hospital gown, from the rail to the bed."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ....perception.classical import ClassicalSenses
from ....sim.errors import CaretreeError
from ....sim.world import World
from ....skills.core.context import Context
from ....skills.scripted.rehearsal import rehearsal
from ....skills.scripted.scripted_senses import ScriptedSenses
from ...nodes.composers import sequence
from ...nodes.decorators import FailSafe
from .dress import dress, make_safe, spread
from .lay import unfold
from .take_down import take_down

STAGES = {"A": take_down, "B": unfold, "C": dress, "D": spread}


def build(context: Context, stage: str = "") -> Behaviour:
    """All stages, or `stage` alone ("C"), or from one to another ("C-D").

    Raises:
        CaretreeError: no such stage.
    """
    first, _, last = (stage or "A-D").partition("-")
    letters = list(STAGES)
    if first not in letters or (last or first) not in letters[letters.index(first) :]:
        raise CaretreeError(f"the dressing task has no stage {stage!r}; it has {', '.join(STAGES)}, and spans like C-D")
    chosen = letters[letters.index(first) : letters.index(last or first) + 1]
    context.offer_senses(ClassicalSenses(context.world.room, context.seed))
    stages = [STAGES[letter](context) for letter in chosen]
    return FailSafe("dress safely", sequence("dressing", *stages), make_safe(context))


def scripted(seed: int) -> tuple[World, ScriptedSenses]:
    """The world on which the task is rehearsed: every grasp succeeds, and what is seen is made up."""
    return rehearsal(seed)
