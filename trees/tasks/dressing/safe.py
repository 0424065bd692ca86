"""What the dressing tree owes the person whenever a stage fails."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ....sim.world import SIDES, Side
from ....skills.core.context import Context
from ....skills.core.reasons import Reason
from ....skills.core.scope import Scope
from ....skills.geometry.stances import stance
from ....skills.lower_arm import LowerArm
from ....skills.navigate import Navigate
from ....skills.retreat import Retreat
from ...nodes.composers import fallback, sequence
from ...nodes.decorators import RecoverBy
from .arm import arm_scope, let_down
from .patience import unhurried
from .tuning import DRESSING


def make_safe(context: Context) -> Behaviour:
    """Lower held arms, let go of everything, back off; then put down an arm that is still up and within reach."""
    hands = Scope(context, "safe", left="left", right="right")
    return sequence(
        "make safe",
        *(let_down(f"{side} hand", hands, side) for side in SIDES),
        unhurried(hands, Retreat("let go and back off", hands, base_distance=DRESSING.safe_back_off, ready="never")),
        *(put_down_if_possible(context, side) for side in SIDES),
    )


def put_down_if_possible(context: Context, side: Side) -> Behaviour:
    """By whichever hand reaches the arm from where the robot stands, else from beside it; where none does, it is left.

    An arm that was out of reach stayed 0.41 m up (134).  Only one that is seen up makes the robot drive.
    """
    arm = arm_scope(context, f"safe {side} arm", side)

    def lower(hand: str) -> LowerArm:
        return LowerArm(f"lower it, {hand} hand", arm, hand=arm[hand], ready="never")

    def go() -> Navigate:
        return Navigate("go to it", arm, goal=stance(side, "lift"))

    # from beside it also shows to whoever has closed the fingers on nothing
    elsewhere = {Reason.UNREACHABLE: go, Reason.GRASP_MISSED: go, Reason.ARM_SLIPPED: go}
    from_beside = RecoverBy(f"safe: to the {side} arm", lower("lifting"), elsewhere)
    leave = Retreat("leave it up", arm, hand_distance=0.0, ready="never")
    return fallback(f"safe: {side} arm", lower("pulling"), from_beside, leave)
