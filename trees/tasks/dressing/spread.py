"""The stage `spread` of the dressing tree: draw up sleeves that slipped down, and lay the collar straight."""

from __future__ import annotations

import numpy as np
from py_trees.behaviour import Behaviour

from ....sim.world import SIDES, Side
from ....skills.check_sleeve import CheckSleeve, CheckSleeveTuning
from ....skills.core.context import Context
from ....skills.core.reasons import Reason
from ....skills.core.scope import Scope
from ....skills.geometry.stances import stance, stance_at_head
from ....skills.look_at_person import LookAtPerson
from ....skills.navigate import Navigate
from ....skills.seat_sleeves import SeatSleeves
from ....skills.spread import Spread
from ...nodes.composers import fallback, sequence
from ...nodes.condition import Condition
from ...nodes.decorators import RecoverBy, Stage, timed_stage
from .arm import MISSES, arm_scope, back_off, grasp_worn, put_down, up_arm
from .check_collar import CheckCollar, CheckCollarTuning
from .tuning import DRESSING

LOW = (Reason.SLEEVE_LOW, Reason.SLEEVE_MISSED)  # below the elbow the cuff does not show all round the arm

# Seen from the head of the bed, cuffs of arms inside them show 17 to 58 % of the way round (101, 103); whether an arm
# is inside is looked at from beside it.
FROM_HEAD = CheckSleeveTuning(min_share_round=0.1)
MIDDLE = CheckCollarTuning(min_shown=DRESSING.collar_shown)
ASIDE, HEADWARD, FOOTWARD = DRESSING.collar_neat
NEAT = CheckCollarTuning(max_aside=ASIDE, max_headward=HEADWARD, max_footward=FOOTWARD)


def spread(context: Context) -> Stage:
    """The stage `spread`: both sleeves up, the collar in the middle, the chest covered.

    A sleeve that is drawn up takes the front along, and with it the other one down: from the head of the bed both are
    drawn up at once where both are low, and then the collar is brought to the middle.
    """
    bed = Scope(context, "gown")
    return timed_stage(
        "spread",
        arm_lies(context, "left"),
        arm_lies(context, "right"),
        *go_to_head(bed),
        *(raised(context, bed, side) for side in SIDES),
        *neaten(context, bed),
        *(node for side in SIDES for node in sits(context, f"{side} in the end", side, DRESSING.armhole_will_do)),
        CheckCollar("the collar lies in the middle", bed, tuning=MIDDLE),
        *(node for side in SIDES for node in still_inside(context, side)),
        LookAtPerson("look at the chest", Scope(context, "chest", side="right"), part="trunk"),
        Condition("the chest is covered", chest_covered, Reason.NOTHING_SEEN),
        seconds=DRESSING.spread_timeout,
    )


def go_to_head(scope: Scope) -> list[Behaviour]:
    """To the head of the bed, from where both hands reach both shoulders and the whole collar shows."""
    return [
        Navigate("go round to the head", scope, goal="bed_head"),
        Navigate("go up", scope, goal=stance_at_head()),
    ]


def go_beside(sleeve: Scope, side: Side) -> list[Behaviour]:
    """To beside a shoulder, the arm in view."""
    return [
        Navigate("go round to its side", sleeve, goal=f"bed_{side}"),
        Navigate("go up to it", sleeve, goal=stance(side, "shoulder")),
        LookAtPerson("go up and look", sleeve),
    ]


def arm_lies(context: Context, side: Side) -> Behaviour:
    """From beside it, see that an arm lies: lowered later, it would draw its sleeve down again."""
    arm = arm_scope(context, f"{side} sleeve", side)
    return sequence(
        f"the {side} arm lies",
        *go_beside(arm, side),
        put_down("first", arm),
        back_off("leave", arm, DRESSING.back_off_distance),
    )


def raised(context: Context, bed: Scope, side: Side) -> Behaviour:
    """A sleeve that is far down its arm is drawn up by its strap, from beside the shoulder."""
    sleeve = arm_scope(context, f"{side} strap", side)

    def by_strap() -> Behaviour:
        def come_back() -> Behaviour:
            away = back_off("let the strap go", sleeve, DRESSING.back_off_distance)
            return sequence("come back to the sleeve", away, *go_beside(Scope(sleeve, "again"), side))

        once = sequence("draw up once", grasp_worn("grasp", sleeve), up_arm(sleeve, DRESSING.again_load))
        drawn = RecoverBy("draw at the sleeve", once, dict.fromkeys(MISSES, come_back))
        return sequence(
            f"draw the {side} sleeve up again",
            back_off("leave the head", sleeve, DRESSING.back_off_distance),
            *go_beside(sleeve, side),
            fallback("by its strap", drawn, back_off("leave it there", sleeve)),
            back_off("leave", sleeve, DRESSING.back_off_distance),
            *go_to_head(Scope(bed, side)),
        )

    seen = sequence(f"see whether the {side} front is near", *sits(context, side, side, DRESSING.armhole_in_reach))
    near = RecoverBy(f"the {side} front is near", seen, dict.fromkeys(LOW, by_strap))
    return fallback(f"near or not, {side}", near, back_off("go on", sleeve))


def neaten(context: Context, bed: Scope) -> list[Behaviour]:
    """From the head of the bed, draw up sleeves that are low, then lay the collar straight.

    Where either gets no farther, it may do all the same, which is looked at in the end.  A sleeve that is drawn up
    takes the collar along, and where the collar lay on its side, to the middle; laid there before, it sprang back.
    """

    def seat() -> Behaviour:
        draw = SeatSleeves("seat", bed, enough=DRESSING.armhole_sits)
        return sequence("draw them up", draw, back_off("clear the view of them", bed))

    def straighten() -> Behaviour:
        return sequence("lay it straight", Spread("spread", bed), back_off("clear the view of it", bed))

    looks = [node for side in SIDES for node in sits(context, f"{side} now", side, DRESSING.armhole_sits)]
    sit = RecoverBy("until they sit", sequence("both sit", *looks), dict.fromkeys(LOW, seat))
    lies = RecoverBy(
        "until it lies straight", CheckCollar("collar", bed, tuning=NEAT), {Reason.COLLAR_ASIDE: straighten}
    )
    return [
        fallback("as far as they go", sit, back_off("leave them", bed)),
        fallback("as straight as it gets", lies, back_off("leave it", bed)),
    ]


def sits(context: Context, name: str, side: Side, reach: float) -> list[Behaviour]:
    """Look from the head of the bed whether a sleeve is up far enough."""
    sleeve = arm_scope(context, name, side)
    return [LookAtPerson("look", sleeve), CheckSleeve("sits", sleeve, min_reach=reach, tuning=FROM_HEAD)]


def still_inside(context: Context, side: Side) -> list[Behaviour]:
    """Look from beside the bed whether the arm is inside its sleeve in the end: its cuff shows all round it there."""
    sleeve = arm_scope(context, f"{side} cuff", side)
    return [
        Navigate("go round to see it", sleeve, goal=f"bed_{side}"),
        LookAtPerson("look", sleeve),
        CheckSleeve("is inside", sleeve),
    ]


def chest_covered(context: Context) -> bool:
    """The head camera sees gown on most of the trunk, which lies where the map's bed says."""
    bed = context.world.room.bed
    shoulders = np.array((*bed[:, :2].mean(axis=0), bed[1, 2])) + DRESSING.shoulders_on_bed
    cover = context.senses.chest_cover(context.world.look("head"), shoulders_in_map=shoulders)
    return cover.share > DRESSING.covered_share
