"""Lay a gown anew that has no arm in it: taken up by a strap, carried off, unfolded, and laid on the person again."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ....sim.world import Side
from ....skills.core.context import Context
from ....skills.core.scope import Scope
from ....skills.geometry.stances import stance
from ....skills.grasp_sleeve import GraspSleeve
from ....skills.look_at_person import LookAtPerson
from ....skills.navigate import Navigate
from ....skills.retreat import Retreat
from ...nodes.composers import fallback, sequence
from .arm import arm_scope, hands_freed, off_trunk
from .lay import ends_anew, on_person
from .take_up import GoToStrap, TakeUpGown
from .tuning import DRESSING


def take(arm: Scope) -> Behaviour:
    """Take the strap of a bare arm's sleeve by the hand that lifts the arm otherwise."""
    by = {"hand": arm["lifting"]}
    grasp = GraspSleeve("take it by its strap", arm, worn=True, **by)
    return sequence(f"{arm.prefix}hold its strap", GoToStrap("go to the strap", arm, **by), grasp)


def laid_anew(context: Context, side: Side) -> Behaviour:
    """Take a gown that has no arm in it up by the strap on this side, carry it off, and lay it anew.

    The strap is right beside an end of the neckline, and held by the hand that holds that end as the gown is laid.  One
    that lies far in, out of that hand's reach, is carried out first.
    """
    arm = arm_scope(context, "taken up", side)
    gown = Scope(context, "anew", keys=("width",))
    return sequence(
        "the gown laid anew",
        *hands_freed(arm),
        Navigate("go to its side", arm, goal=f"bed_{side}"),
        Navigate("come to it", arm, goal=stance(side, "lift")),
        LookAtPerson("look", arm),
        fallback(
            "the strap in hand",
            take(arm),
            sequence("the strap nearer, in hand", off_trunk(arm, side), take(Scope(arm, "nearer"))),
        ),
        TakeUpGown("take it up", arm, hand=arm["lifting"]),
        Navigate("draw back with it", arm, goal=f"bed_{side}", speed=DRESSING.taken_up_speed),
        Navigate("carry it off", arm, goal="rail", speed=DRESSING.taken_up_speed),
        fallback(f"{gown.prefix}by both ends", *ends_anew(context, gown, ("one", "rest"))),
        *on_person(gown),
        Retreat("bring the arms back again", arm, hand_distance=DRESSING.arms_back),
        Navigate("go back to its side", arm, goal=f"bed_{side}"),
    )
