"""What the dressing tree owes the person whenever a stage fails."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ....sim.world import SIDES, Side
from ....skills.core.context import Context
from ....skills.core.scope import Scope
from ....skills.lower_arm import LowerArm
from ....skills.retreat import Retreat
from ...nodes.composers import fallback, sequence
from .arm import arm_scope, let_down
from .tuning import DRESSING


def make_safe(context: Context) -> Behaviour:
    """Lower held arms, let go of everything, back off; then put down an arm that is still up and within reach."""
    hands = Scope(context, "safe", left="left", right="right")
    return sequence(
        "make safe",
        *(let_down(f"{side} hand", hands, side) for side in SIDES),
        Retreat("let go and back off", hands, base_distance=DRESSING.safe_back_off, ready="never"),
        *(put_down_if_possible(context, side) for side in SIDES),
    )


def put_down_if_possible(context: Context, side: Side) -> Behaviour:
    """By whichever hand reaches the arm from where the robot stands; it is no failure where none does."""
    arm = arm_scope(context, f"safe {side} arm", side)

    def lower(hand: str) -> LowerArm:
        return LowerArm(f"lower it, {hand} hand", arm, hand=arm[hand], ready="never")

    leave = Retreat("leave it up", arm, hand_distance=0.0, ready="never")
    return fallback(f"safe: {side} arm", lower("pulling"), lower("lifting"), leave)
