"""Draw a blanket up to the person's chest, on one side of the bed and then on the other.

    caretree run draw_blanket --seed 100 --set first=left

| stage | what it does |
|---|---|
| first_side | goes beside the bed, looks for the arm, takes the blanket's edge, draws it up to the chest |
| other_side | the same from the other side; then waits and sees that the edge lies there |
"""

from __future__ import annotations

from typing import Annotated

from py_trees.behaviour import Behaviour

from ....perception.senses import Senses
from ....sim.world import Side
from ....skills.core.context import Context
from ....skills.core.reasons import Reason
from ....skills.core.scope import Scope
from ....skills.geometry.stances import HEADWARD, LIFTING
from ....skills.hold_still import HoldStill
from ....skills.look_at_person import LookAtPerson
from ....skills.navigate import Navigate
from ....skills.retreat import Retreat
from ...nodes.composers import sequence
from ...nodes.condition import Condition
from ...nodes.decorators import FailSafe, RecoverBy, Stage, timed_stage
from ...run.parameters import Parameter
from .draw_up import DrawUp
from .rehearsal import scripted
from .room import judge, scene
from .senses import BlanketSenses
from .take_edge import TakeEdge

MISSED = (Reason.GRASP_MISSED, Reason.NOTHING_SEEN, Reason.COMMAND_LOST, Reason.ARM_LOST)
UP_TO = 0.40  # of the edge below the shoulders where it counts as drawn up, as it is seen to 0.04 [m]
SHOULDERS = 0.55  # of an adult's, from the middle of the bed towards its head [m]

__all__ = ["build", "judge", "scene", "scripted", "senses"]


def drawn_up(context: Context) -> bool:
    """The head's camera sees the edge no farther down than on the chest."""
    edge = context.senses.hang_point(context.world.look("head")).position_in_map
    middle = context.world.room.bed[:, :2].mean(axis=0)
    return bool((edge[:2] - middle) @ HEADWARD[:2] > SHOULDERS - UP_TO)


CONDITIONS = (drawn_up,)


def senses(context: Context) -> Senses:
    """What sees, unless the run was given others."""
    return BlanketSenses(context.world.room, context.rng)


def build(
    context: Context,
    first: Annotated[Side, Parameter("side that is drawn up first, the person's own left or right")] = "right",
) -> Behaviour:
    """One side after the other; a miss is tried again from a fresh look."""
    other: Side = "left" if first == "right" else "right"
    body = sequence("draw the blanket up", draw(context, "first_side", first), draw(context, "other_side", other))
    safe = Retreat("let go and back off", Scope(context, "end"), base_distance=0.2, ready="never")
    return FailSafe("draw the blanket up safely", body, safe)


def draw(context: Context, name: str, side: Side) -> Stage:
    """Beside one side of the bed, draw the blanket's edge up to the chest."""
    scope = Scope(context, side, keys=("inset",), side=side, hand=LIFTING[side])

    def again() -> Behaviour:
        return Retreat("let go and look again", scope)

    once = sequence(
        f"{side}: take it and draw",
        Navigate("go beside the bed", scope, goal=f"bed_{side}"),
        LookAtPerson("look for the arm", scope),
        TakeEdge("take the edge", scope),
        DrawUp("draw it up", scope),
        Retreat("back off", scope, base_distance=0.3, hand_distance=0.0),
        HoldStill("see it lie", scope, seconds=2.5),
        Condition(f"{side}: the edge is at the chest", drawn_up, Reason.GRASP_MISSED),
    )
    return timed_stage(
        name, RecoverBy(f"{side}: drawn up", once, dict.fromkeys(MISSED, again), attempts=3), seconds=240.0
    )
