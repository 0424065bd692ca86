"""The stage `dress` of the dressing tree: the right arm, round the foot of the bed, the left arm, the front flat."""

from __future__ import annotations

from ....skills.core.context import Context
from ....skills.core.scope import Scope
from ....skills.navigate import Navigate
from ....skills.retreat import Retreat
from ...nodes.composers import fallback
from ...nodes.decorators import Stage, timed_stage
from .arm import arm_scope, at_hand, back_off, carried_across, dress_arm, flat, not_slipped
from .tuning import DRESSING, FIRST_SLEEVE, SECOND_SLEEVE


def dress(context: Context) -> Stage:
    """The stage `dress`."""
    bed = Scope(context, "bed")
    return timed_stage(
        "dress",
        Retreat("bring the arms back", bed, hand_distance=DRESSING.arms_back),
        Navigate("go to the right side", bed, goal="bed_right"),
        dress_arm(context, "right", FIRST_SLEEVE),
        fallback(
            "bring the left sleeve to its side",
            carried_across("the left sleeve", bed, "left"),
            back_off("leave the left sleeve", bed),
        ),
        # not before the other sleeve is gone from this side: its strap was taken for that of the first one (147)
        not_slipped(arm_scope(context, "first sleeve", "right"), DRESSING.first_sleeve_up, pulls=1),
        Navigate("go round to the left side", bed, goal="bed_left"),
        at_hand(arm_scope(context, "second sleeve", "left")),
        dress_arm(context, "left", SECOND_SLEEVE),
        flat(arm_scope(context, "front", "left")),
        seconds=DRESSING.dress_timeout,
    )
