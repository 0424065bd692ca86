"""What the dressing tree owes the person whenever a stage fails."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ....sim.world import SIDES, Side
from ....skills.core.context import Context
from ....skills.core.scope import Scope
from ....skills.release_arm import ReleaseArm
from ....skills.retreat import Retreat
from ...nodes.composers import fallback, sequence
from .tuning import DRESSING


def make_safe(context: Context) -> Behaviour:
    """Lower a held arm, let go, back off, stop."""
    safe = Scope(context, "safe")

    def let_go(hand: Side) -> Behaviour:
        lower = ReleaseArm(f"{hand} hand lowers the arm", safe, hand=hand, lower=True)
        return fallback(f"safe: {hand} hand", lower, ReleaseArm(f"{hand} hand opens", safe, hand=hand))

    back = Retreat("let go and back off", safe, base_distance=DRESSING.safe_back_off, ready="never")
    return sequence("make safe", *(let_go(side) for side in SIDES), back)
