"""The stage `dress` of the dressing tree: the right arm, round the foot of the bed, the left arm, the front flat.

Where the right arm does not come into its sleeve, in one try if that was seen to lie, the left arm is dressed before
it: with that one in its sleeve, the gown lies on the chest, where its other sleeve reaches farther.
"""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ....sim.world import SIDES, Side
from ....skills.belief.lying_sleeves import laid_here, lying_sleeves
from ....skills.core.context import Context
from ....skills.core.scope import Scope
from ....skills.look_at_person import LookAtPerson
from ....skills.navigate import Navigate
from ....skills.retreat import Retreat
from ...nodes.composers import fallback, sequence
from ...nodes.condition import Condition
from ...nodes.decorators import RecoverBy, Stage, timed_stage
from .arm import (
    MISSES,
    arm_scope,
    at_hand,
    back_off,
    carried_across,
    dress_arm,
    flat,
    hands_freed,
    not_slipped,
    worn_already,
)
from .draw_flat import NEARER_THE_CHEST
from .lay_anew import laid_anew
from .tuning import DRESSING, FIRST_SLEEVE, SECOND_SLEEVE


def dress(context: Context) -> Stage:
    """The stage `dress`."""
    bed = Scope(context, "bed")
    return timed_stage(
        "dress",
        Retreat("bring the arms back", bed, hand_distance=DRESSING.arms_back),
        fallback("both arms dressed", right_then_left(context, bed), left_then_right(context)),
        seconds=DRESSING.dress_timeout,
    )


def right_then_left(context: Context, bed: Scope) -> Behaviour:
    """Both arms into their sleeves; the robot stands at the right one when the gown is laid."""
    return sequence(
        "right, then left",
        Navigate("go to the right side", bed, goal="bed_right"),
        first_arm(context),
        fallback(
            "bring the left sleeve to its side",
            carried_across("the left sleeve", bed, "left"),
            back_off("leave the left sleeve", bed),
        ),
        # not before the other sleeve is gone from this side: its strap was taken for that of the first one (147)
        not_slipped(arm_scope(context, "first sleeve", "right"), DRESSING.first_sleeve_up, pulls=1),
        Navigate("go round to the left side", bed, goal="bed_left"),
        asked_first(
            arm_scope(context, "left so far", "left"),
            at_hand(arm_scope(context, "second sleeve", "left")),
            dress_arm(context, "left", SECOND_SLEEVE),
        ),
        flat(arm_scope(context, "front", "left")),
    )


def first_arm(context: Context) -> Behaviour:
    """The right arm into its sleeve; where it does not come into one that stands, the gown is laid anew, once.

    A gown that lies to the far side stops short of the hand, 0.27 to 0.38 m three times alike (103); with the other arm
    first it then went over the edge.
    """

    def anew() -> Behaviour:
        stands = Condition("the right sleeve stood", right_sleeve_stands)
        return sequence("laid anew, if it stood", stands, laid_anew(context, "right"))

    arm = dress_arm(
        context,
        "right",
        FIRST_SLEEVE,
        attempts=DRESSING.first_arm_attempts,
        worth=lambda: Condition("the right sleeve stands", right_sleeve_stands),
    )
    dressed = asked_first(arm_scope(context, "right so far", "right"), arm)
    return RecoverBy("the right arm, or laid anew", dressed, dict.fromkeys(MISSES, anew))


def right_sleeve_stands(context: Context) -> bool:
    """The gown was not seen to be laid with its right sleeve down.

    Such a sleeve may go on at the first try (124); where it does not, it stops short of the hand (126, 135), as it
    would again: the left arms of the same gowns went in at the first try, and the right ones after them.
    """
    return "right" not in lying_sleeves(context)


def left_then_right(context: Context) -> Behaviour:
    """Put down what is held at either arm, and dress the left arm first, or the one that is not in its sleeve yet.

    A gown that hangs over the far edge stops 0.2 to 0.3 m short of the right hand, six times alike (126, 129).
    """
    return sequence(
        "left, then right",
        *(node for side in SIDES[::-1] for node in hands_freed(arm_scope(context, f"{side} freed", side))),
        on_their_arms(context, "yet", "2nd"),
        flat(arm_scope(context, "its front", "right"), NEARER_THE_CHEST),
    )


def dressed_anew(context: Context) -> Behaviour:
    """Dress an arm again whose sleeve is not seen on it from beside, after the gown was thought to be worn.

    Such a sleeve had missed its arm, and lay beside it under a fold (185); or it came off since.
    """
    return on_their_arms(context, "before", "new")


def on_their_arms(context: Context, seen: str, dressed: str) -> Behaviour:
    """See both sleeves on their arms, the left one first, and dress an arm whose sleeve is not.

    Leaves that look are called by the side and `seen`, those that dress by the side and `dressed`.
    """

    def on_its_arm(side: Side) -> Behaviour:
        beside = arm_scope(context, f"{side} {seen}", side)
        on = sequence(f"the {side} sleeve on it", *seen_worn(beside))
        arm = dress_arm(context, side, SECOND_SLEEVE, name=f"{side} {dressed}")
        rest = sequence(f"the {side} arm", at_hand(beside), arm)
        go = Navigate("go and see it", beside, goal=f"bed_{side}")
        return sequence(f"the {side} arm in its sleeve", go, fallback(f"the {side} arm dressed", on, rest))

    return sequence("both arms in their sleeves", *(on_its_arm(side) for side in SIDES))


def asked_first(so_far: Scope, *dressing: Behaviour) -> Behaviour:
    """Dress an arm unless it is seen in its sleeve, of which nobody is asked where this run has laid the gown."""
    side = so_far["side"]
    asked = Condition(f"the {side} arm may be dressed", laid_by_others)
    on = sequence(f"the {side} sleeve on it", asked, *seen_worn(so_far))
    return fallback(f"the {side} arm dressed", on, sequence(f"the {side} arm", *dressing))


def laid_by_others(context: Context) -> bool:
    """The gown was not laid in this run: whoever laid it may have dressed an arm, which is not to be lifted then."""
    return not laid_here(context)


def seen_worn(beside: Scope) -> list[Behaviour]:
    """See from beside an arm that it is in its sleeve."""
    return [LookAtPerson("look", beside), worn_already(beside)]
