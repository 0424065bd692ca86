"""The stage `spread` of the dressing tree: draw up sleeves that slipped down, and lay the collar straight."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from py_trees.behaviour import Behaviour

from ....sim.world import Side
from ....skills.check_sleeve import CheckSleeve
from ....skills.core.context import Context
from ....skills.core.reasons import Reason
from ....skills.core.scope import Scope
from ....skills.geometry.stances import LIFTING, PULLING, stance
from ....skills.look_at_person import LookAtPerson
from ....skills.navigate import Navigate
from ....skills.seat_sleeve import SeatSleeve
from ....skills.spread import Spread
from ...nodes.composers import fallback, sequence
from ...nodes.condition import Condition
from ...nodes.decorators import RecoverBy, Stage, timed_stage
from .arm import MISSES, arm_scope, back_off, grasp_worn, put_down, up_arm
from .check_collar import CheckCollar, CheckCollarTuning
from .tuning import DRESSING

LOW = (Reason.SLEEVE_LOW, Reason.SLEEVE_MISSED)  # below the elbow the cuff does not show all round the arm

ASIDE, HEADWARD, FOOTWARD = DRESSING.collar_room
MIDDLE = CheckCollarTuning(min_shown=DRESSING.collar_shown)
ROOM = CheckCollarTuning(max_aside=ASIDE, max_headward=HEADWARD, max_footward=FOOTWARD)


def spread(context: Context) -> Stage:
    """The stage `spread`: both sleeves up, the collar in the middle, the chest covered.

    The right sleeve, which the left one has pulled down, comes first.  A sleeve that is drawn up takes the front along,
    and with it the other one down, by about half as much as it gains itself: after the left one both are seen to again.
    The collar is taken along too, by up to 20 cm: from the left sleeve on it is straightened after each, which one hand
    holds meanwhile.
    Only then is judged whether the sleeves will do: one that seems low is no reason to leave the rest undone.
    """
    once_more = [settle_sleeve(context, side, " 2", collar=True) for side in ("right", "left")]
    return timed_stage(
        "spread",
        settle_sleeve(context, "right"),
        settle_sleeve(context, "left", then=once_more, collar=True),
        straighten_collar(context, "left", "last collar"),
        will_do(context, "left"),
        CheckCollar("the collar lies in the middle", Scope(context, "collar"), tuning=MIDDLE),
        will_do(context, "right"),
        LookAtPerson("look at the chest", Scope(context, "chest", side="right"), part="trunk"),
        Condition("the chest is covered", chest_covered, Reason.NOTHING_SEEN),
        seconds=DRESSING.spread_timeout,
    )


def straighten_collar(context: Context, side: Side, name: str = "collar") -> Behaviour:
    """From beside one shoulder, bring the collar's middle over the breastbone.

    Where the hand cannot bring it there, it may lie well enough all the same, which is looked at in the end.
    """
    collar = Scope(context, f"{side} {name}", side=side, hand=PULLING[side], holding=LIFTING[side])
    return sequence(
        "straighten the collar",
        Navigate("go round to its side", collar, goal=f"bed_{side}"),
        Navigate("stand there", collar, goal=stance(side, "collar")),
        LookAtPerson("look", collar),
        fallback(
            "bring it to the middle",
            sequence("twice", Spread("spread", collar), Spread("spread again", collar)),
            back_off("let it go", collar),
        ),
        back_off("leave", collar, DRESSING.shoulder_back_off),
    )


def settle_sleeve(
    context: Context, side: Side, when: str = "", then: Sequence[Behaviour] = (), *, collar: bool = False
) -> Behaviour:
    """See to a sleeve that has slipped down: far down, by its strap first; then by the front of its armhole.

    Where that front cannot be taken, the strap is.  The arm lies: lowered later, it would draw the sleeve down again.

    Args:
        context: shared services.
        side: of the sleeve.
        when: what is added to the names of its nodes; another time a sleeve that will do is left as it is.
        then: what follows once it was drawn up.
        collar: whether the collar is straightened before that.
    """
    sleeve = arm_scope(context, f"{side} sleeve{when}", side)

    def go(name: str) -> list[Behaviour]:
        return [
            Navigate(f"{name} to it", sleeve, goal=stance(side, "shoulder")),
            LookAtPerson(f"{name} and look", sleeve),
        ]

    def come_back() -> Behaviour:
        away = back_off("let the strap go", sleeve, DRESSING.back_off_distance)
        return sequence("come back to the sleeve", away, *go("come back"))

    def seat() -> Behaviour:
        """A collar that is near the throat leaves no room: the armhole would take it on over the face."""
        room = fallback(
            "room for the sleeve",
            CheckCollar("the collar leaves room", sleeve, tuning=ROOM),
            sequence(
                "make room",
                straighten_collar(context, side, f"room{when}"),
                *go("then return"),
                CheckCollar("leaves room now", sleeve, tuning=ROOM),
            ),
        )
        strap = Scope(sleeve, "strap")
        by_strap = sequence(
            f"the {side} armhole's front is hidden{when}",
            back_off("leave the front", sleeve),
            grasp_worn("grasp", strap),
            up_arm(strap, DRESSING.again_load),
        )
        front = SeatSleeve("seat", sleeve, hand=sleeve["pulling"])
        drawn = [fallback("by front or strap", front, by_strap), back_off("leave it", sleeve)]
        if collar:
            drawn.append(straighten_collar(context, side, f"collar{when}"))
        return sequence("seat the sleeve", room, *drawn, *(then or go("look again")))

    once = sequence("draw up once", grasp_worn("grasp", sleeve), up_arm(sleeve, DRESSING.again_load))
    drawn = RecoverBy("draw at the sleeve", once, dict.fromkeys(MISSES, come_back))
    draw_up = sequence(
        "draw the sleeve up again", drawn, back_off("leave", sleeve, DRESSING.back_off_distance), *go("return")
    )
    near = CheckSleeve("is near the shoulder", sleeve, min_reach=DRESSING.armhole_in_reach)
    sits = CheckSleeve("sits", sleeve, min_reach=DRESSING.armhole_low if when else DRESSING.armhole_sits)
    return sequence(
        f"settle the {side} sleeve{when}",
        Navigate("go round to its side", sleeve, goal=f"bed_{side}"),
        *go("go up"),
        put_down("first", sleeve),
        fallback("near the shoulder", near, draw_up, back_off("leave it there", sleeve, DRESSING.back_off_distance)),
        fallback(
            "as far as the sleeve goes",
            RecoverBy("until the sleeve sits", sits, dict.fromkeys(LOW, seat), attempts=DRESSING.settle_attempts),
            back_off("leave it as it is", sleeve, DRESSING.back_off_distance),
        ),
        put_down("at last", sleeve),
    )


def will_do(context: Context, side: Side) -> Behaviour:
    """Look from its side of the bed whether the sleeve is up far enough."""
    sleeve = arm_scope(context, f"{side} sleeve", side)
    return sequence(
        f"see whether the {side} sleeve will do",
        Navigate("go round to see it", sleeve, goal=f"bed_{side}"),
        LookAtPerson("look at the end", sleeve),
        CheckSleeve("will do", sleeve, min_reach=DRESSING.armhole_will_do),
    )


def chest_covered(context: Context) -> bool:
    """The head camera sees gown on most of the trunk, which lies where the map's bed says."""
    bed = context.world.room.bed
    shoulders = np.array((*bed[:, :2].mean(axis=0), bed[1, 2])) + DRESSING.shoulders_on_bed
    cover = context.senses.chest_cover(context.world.look("head"), shoulders_in_map=shoulders)
    return cover.share > DRESSING.covered_share
