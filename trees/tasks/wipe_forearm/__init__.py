"""Wipe one of the person's forearms with a folded cloth, pressed on with 2 to 5 N, and put the cloth back.

    caretree run wipe_forearm --seed 100 --set arm=left --set strokes=6

| stage | what it does |
|---|---|
| fetch | goes to the table, looks for the cloth, takes it from above and lifts it |
| wipe | goes beside the arm, looks, and wipes to and fro with an even force |
| return | goes back and puts the cloth where it stood |
"""

from __future__ import annotations

from typing import Annotated

from py_trees.behaviour import Behaviour

from ....perception.senses import Senses
from ....sim.world import Side
from ....skills.core.context import Context
from ....skills.core.reasons import Reason
from ....skills.core.scope import Scope
from ....skills.geometry.stances import PULLING, stance
from ....skills.hold_still import HoldStill
from ....skills.look_at_person import LookAtPerson
from ....skills.navigate import Navigate
from ....skills.retreat import Retreat
from ....skills.segment_and_grasp import SegmentAndGrasp
from ....skills.unhook import Unhook
from ...nodes.composers import sequence
from ...nodes.decorators import FailSafe, RecoverBy, timed_stage
from ...run.parameters import Parameter
from .put_back import PutBack
from .rehearsal import scripted
from .room import judge, scene
from .senses import WashingSenses
from .wipe import Wipe

MISSED = (Reason.GRASP_MISSED, Reason.NOTHING_SEEN, Reason.COMMAND_LOST)
NOT_FOUND = (Reason.ARM_LOST, Reason.NOTHING_SEEN, Reason.COMMAND_LOST)

__all__ = ["build", "judge", "scene", "scripted", "senses"]


def senses(context: Context) -> Senses:
    """What sees, unless the run was given others."""
    return WashingSenses(context.world.room, context.rng)


def build(
    context: Context,
    arm: Annotated[Side, Parameter("whose forearm, the person's own left or right")] = "right",
    strokes: Annotated[int, Parameter("ways along the forearm, to and fro", unit="1", low=1, high=20)] = 4,
) -> Behaviour:
    """Fetch the cloth, wipe, put it back; a miss is tried again, and a push ends with the hand drawn off."""
    scope = Scope(context, "cloth", keys=("grasp",), side=arm, hand=PULLING[arm])

    def let_go() -> Behaviour:
        return Retreat("let go and look again", scope)

    def wait() -> Behaviour:
        return HoldStill("wait before wiping again", scope)

    take = sequence("take and lift", SegmentAndGrasp("take", scope), Unhook("lift", scope, height=0.15, min_load=0.4))
    wipe = sequence("look and wipe", LookAtPerson("look", scope), Wipe("wipe", scope, strokes=strokes))
    body = sequence(
        "wipe a forearm",
        timed_stage(
            "fetch",
            Navigate("go to the table", scope, goal="rail"),
            RecoverBy("get it", take, dict.fromkeys(MISSED, let_go), attempts=3),
            seconds=150.0,
        ),
        timed_stage(
            "wipe",
            Navigate("go to the arm", scope, goal=stance(arm, "lift")),
            RecoverBy("wipe it", wipe, dict.fromkeys(NOT_FOUND, wait), attempts=3),
            seconds=180.0,
        ),
        timed_stage(
            "return",
            Navigate("go back", scope, goal="rail"),
            PutBack("put it back", scope),
            seconds=120.0,
        ),
    )
    safe = Retreat("let go and back off", scope, base_distance=0.2, ready="never")
    return FailSafe("wipe a forearm safely", body, safe)
