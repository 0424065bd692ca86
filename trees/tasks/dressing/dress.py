"""The stage `dress` of the dressing tree: the right arm, round the foot of the bed, the left arm, the front flat."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ....skills.core.context import Context
from ....skills.core.scope import Scope
from ....skills.navigate import Navigate
from ....skills.retreat import Retreat
from ...nodes.composers import fallback, sequence
from ...nodes.decorators import Stage, timed_stage
from .arm import arm_scope, back_off, carried_across, dress_arm
from .draw_flat import DrawFlat
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
        Navigate("go round to the left side", bed, goal="bed_left"),
        dress_arm(context, "left", SECOND_SLEEVE),
        flat(context),
        seconds=DRESSING.dress_timeout,
    )


def flat(context: Context) -> Behaviour:
    """From where the left arm was dressed, draw folds out of the front; where it cannot be done, the rest may do."""
    front = arm_scope(context, "front", "left")
    draw = DrawFlat("draw flat", front, hand=front["pulling"])
    drawn = sequence("draw it flat", draw, back_off("off the front", front))
    return fallback("no folds", drawn, back_off("leave the front", front))
