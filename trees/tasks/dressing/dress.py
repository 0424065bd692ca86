"""The stage `dress` of the dressing tree: the right arm, round the foot of the bed, the left arm, the front flat."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ....sim.world import SIDES, Side
from ....skills.core.context import Context
from ....skills.core.scope import Scope
from ....skills.look_at_person import LookAtPerson
from ....skills.navigate import Navigate
from ....skills.retreat import Retreat
from ...nodes.composers import fallback, sequence
from ...nodes.decorators import Stage, timed_stage
from .arm import arm_scope, at_hand, back_off, carried_across, dress_arm, flat, not_slipped, worn_already
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


def dressed_anew(context: Context) -> Behaviour:
    """Dress an arm again whose sleeve is not seen on it from beside, after the gown was thought to be worn.

    Such a sleeve had missed its arm, and lay beside it under a fold (185); or it came off since.
    """

    def on_its_arm(side: Side) -> Behaviour:
        beside = arm_scope(context, f"{side} before", side)
        on = sequence(f"the {side} sleeve on it", LookAtPerson("look", beside), worn_already(beside))
        arm = sequence(f"the {side} arm", at_hand(beside), dress_arm(context, side, SECOND_SLEEVE, name=f"{side} new"))
        go = Navigate("go and see it", beside, goal=f"bed_{side}")
        return sequence(f"the {side} arm in its sleeve", go, fallback(f"the {side} arm dressed", on, arm))

    return sequence("both arms in their sleeves", *(on_its_arm(side) for side in SIDES))
