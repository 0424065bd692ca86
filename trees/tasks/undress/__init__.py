"""Take the gown off a person who lies in it, one arm and then the other.

    caretree run undress --seed 100 --set first=left

| stage | what it does |
|---|---|
| first_arm | goes beside the bed, looks for the arm, takes the seam over the shoulder, draws the sleeve off the arm |
| other_arm | the same from the other side, and farther: the gown is drawn off the trunk; then sees that it is bare |
"""

from __future__ import annotations

from typing import Annotated

import numpy as np
from py_trees.behaviour import Behaviour

from ....perception.classical import ClassicalSenses
from ....perception.errors import PerceptionFailure
from ....perception.senses import Senses
from ....sim.world import SIDES, Side
from ....skills.core.context import Context
from ....skills.core.reasons import Reason
from ....skills.core.scope import Scope
from ....skills.geometry.stances import LIFTING
from ....skills.hold_still import HoldStill
from ....skills.look_at_person import LookAtPerson
from ....skills.navigate import Navigate
from ....skills.retreat import Retreat
from ...nodes.composers import sequence
from ...nodes.condition import Condition
from ...nodes.decorators import FailSafe, RecoverBy, Stage, timed_stage
from ...run.parameters import Parameter
from .draw_off import DrawOff
from .rehearsal import scripted
from .room import judge
from .take_seam import TakeSeam

BEGINS = "gown_dressed"
MISSED = (Reason.GRASP_MISSED, Reason.NOTHING_SEEN, Reason.SLEEVE_CAUGHT, Reason.CLOTH_SLIPPED)
LOST = (Reason.COMMAND_LOST, Reason.ARM_LOST)
BESIDE, FAR = 0.3, 0.45  # footward of the fingertips, where the first sleeve is laid, and where the gown is [m]
OFF = 1.5  # along the upper arm, beyond which the tape of an armhole is off the arm or about to be
HAND_POINTS = 10  # along it, at which it is looked at
COVERED = 0.3  # share of a hand, or of the trunk, from which it is not bare

__all__ = ["build", "judge", "scripted", "senses"]


def right_arm_bare(context: Context) -> bool:
    """The head's camera sees the right hand, and no sleeve about the arm."""
    return _bare(context, "right")


def left_arm_bare(context: Context) -> bool:
    """The head's camera sees the left hand, and no sleeve about the arm."""
    return _bare(context, "left")


def _bare(context: Context, side: Side) -> bool:
    frame = context.world.look("head")
    arm = context.senses.arm(frame, side=side).points_in_map
    hand = np.linspace(arm[2], arm[3], HAND_POINTS)
    if context.senses.skin_cover(frame, points_in_map=hand).share > COVERED:
        return False
    try:
        return context.senses.worn_sleeve(frame, side=side, arm_in_map=arm).armhole_at > OFF
    except PerceptionFailure:
        return True  # of a sleeve on an arm, both tapes show


def trunk_bare(context: Context) -> bool:
    """The head's camera sees no gown on chest and belly."""
    frame = context.world.look("head")
    arms = [context.senses.arm(frame, side=side).points_in_map for side in SIDES]
    middle = (arms[0][0] + arms[1][0]) / 2
    return context.senses.chest_cover(frame, shoulders_in_map=middle).share < COVERED


CONDITIONS = (right_arm_bare, left_arm_bare, trunk_bare)
BARE = {"right": right_arm_bare, "left": left_arm_bare}


def senses(context: Context) -> Senses:
    """What sees, unless the run was given others."""
    return ClassicalSenses(context.world.room, context.rng)


def build(
    context: Context,
    first: Annotated[Side, Parameter("arm that is undressed first, the person's own left or right")] = "right",
) -> Behaviour:
    """One arm after the other; a miss is tried again from a fresh look."""
    other: Side = "left" if first == "right" else "right"
    body = sequence(
        "take the gown off",
        undress(context, "first_arm", first, BESIDE),
        undress(context, "other_arm", other, FAR),
        Condition("the trunk is bare", trunk_bare, Reason.NOTHING_SEEN),
    )
    safe = Retreat("let go and back off", Scope(context, "end"), base_distance=0.2, ready="never")
    return FailSafe("take the gown off safely", body, safe)


def undress(context: Context, name: str, side: Side, beyond: float) -> Stage:
    """Beside one side of the bed, draw the sleeve off the arm and lay its seam down `beyond` [m] the fingertips."""
    scope = Scope(context, side, side=side, hand=LIFTING[side])

    def again() -> Behaviour:
        return Retreat("let go and look again", scope)

    once = sequence(
        f"{side}: take it and draw",
        Navigate("go beside the bed", scope, goal=f"bed_{side}"),
        LookAtPerson("look for the arm", scope),
        TakeSeam("take the seam", scope),
        DrawOff("draw it off", scope, beyond=beyond),
        Retreat("back off", scope, base_distance=0.3, hand_distance=0.0),
        HoldStill("see it lie", scope, seconds=2.5),
        LookAtPerson("look at the arm", scope),
        Condition(f"{side}: the arm is bare", BARE[side], Reason.SLEEVE_CAUGHT),
    )
    return timed_stage(
        name, RecoverBy(f"{side}: undressed", once, dict.fromkeys(MISSED + LOST, again), attempts=3), seconds=240.0
    )
