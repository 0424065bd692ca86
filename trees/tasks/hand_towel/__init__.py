"""Hand the person a towel: take it from its hook, and lay it across one of their hands.

    caretree run hand_towel --seed 100 --set arm=left

| stage | what it does |
|---|---|
| fetch | goes to the hook, looks for the towel, takes it and lifts it off |
| hand_over | goes beside the bed, looks for the arm, lays the towel across the hand, backs off |
"""

from __future__ import annotations

from typing import Annotated

from py_trees.behaviour import Behaviour

from ....perception.senses import Senses
from ....sim.world import Side, World
from ....skills.core.context import Context
from ....skills.core.reasons import Reason
from ....skills.core.scope import Scope
from ....skills.geometry.stances import PULLING
from ....skills.hold_still import HoldStill
from ....skills.look_at_person import LookAtPerson
from ....skills.navigate import Navigate
from ....skills.retreat import Retreat
from ....skills.scripted.rehearsal import rehearsal
from ....skills.scripted.scripted_senses import ScriptedSenses
from ....skills.segment_and_grasp import SegmentAndGrasp
from ....skills.unhook import Unhook
from ...nodes.composers import sequence
from ...nodes.decorators import FailSafe, RecoverBy, timed_stage
from ...run.parameters import Parameter
from .lay_on_hand import LayOnHand
from .room import judge, scene
from .senses import TowelSenses

MISSED = (Reason.GRASP_MISSED, Reason.NOTHING_SEEN, Reason.COMMAND_LOST)
NOT_FOUND = (Reason.ARM_LOST, Reason.NOTHING_SEEN, Reason.COMMAND_LOST)

__all__ = ["build", "judge", "scene", "scripted", "senses"]


def senses(context: Context) -> Senses:
    """What sees, unless the run was given others."""
    return TowelSenses(context.world.room, context.rng)


def build(
    context: Context,
    arm: Annotated[Side, Parameter("to whose hand, the person's own left or right")] = "right",
) -> Behaviour:
    """Fetch the towel and hand it over; a miss is tried again from a fresh look."""
    scope = Scope(context, "towel", keys=("grasp",), side=arm, hand=PULLING[arm])

    def let_go() -> Behaviour:
        return Retreat("let go and look again", scope)

    def wait() -> Behaviour:
        return HoldStill("wait before handing it again", scope)

    take = sequence("take and lift", SegmentAndGrasp("take", scope), Unhook("lift", scope, height=0.12, min_load=0.8))
    give = sequence("look and give", LookAtPerson("look", scope), LayOnHand("lay on the hand", scope))
    body = sequence(
        "hand over a towel",
        timed_stage(
            "fetch",
            Navigate("go to the hook", scope, goal="rail"),
            RecoverBy("get it", take, dict.fromkeys(MISSED, let_go), attempts=3),
            seconds=150.0,
        ),
        timed_stage(
            "hand_over",
            Navigate("go to the bed", scope, goal=f"bed_{arm}"),
            RecoverBy("give it", give, dict.fromkeys(NOT_FOUND, wait), attempts=3),
            Retreat("back off", scope, base_distance=0.3, hand_distance=0.0),
            HoldStill("see it lie", scope, seconds=2.5),
            seconds=180.0,
        ),
    )
    safe = Retreat("let go and back off", scope, base_distance=0.2, ready="never")
    return FailSafe("hand over a towel safely", body, safe)


def scripted(seed: int) -> tuple[World, ScriptedSenses]:
    """The world on which the task is rehearsed: every grasp succeeds, and what is seen is made up."""
    return rehearsal(seed)
