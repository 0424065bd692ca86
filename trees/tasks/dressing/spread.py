"""The stage `spread` of the dressing tree: lay the collar straight, and draw up sleeves that slipped down."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Literal

import numpy as np
from py_trees.behaviour import Behaviour

from ....perception.estimates import ChestCover
from ....sim.world import SIDES, Side
from ....skills.belief.close_look import CloseLook
from ....skills.check_sleeve import CheckSleeve, CheckSleeveTuning
from ....skills.core.context import Context
from ....skills.core.ports import Key
from ....skills.core.reasons import Reason
from ....skills.core.scope import Scope
from ....skills.geometry.stances import stance_at_head
from ....skills.look_at_person import LookAtPerson
from ....skills.lower_arm import LowerArm
from ....skills.navigate import Navigate
from ....skills.seat_sleeves import SeatSleeves
from ....skills.spread import Spread
from ...nodes.composers import fallback, sequence
from ...nodes.condition import Condition
from ...nodes.decorators import RecoverBy, Stage, timed_stage
from .arm import FROM_HEAD, arm_scope, back_off, flat, go_beside, not_slipped, put_down, surely_back
from .check_collar import CheckCollar, CheckCollarTuning
from .check_face import CheckFace
from .check_worn import CheckWorn
from .draw_over import DrawOver
from .look_at_collar import LookAtCollar
from .look_at_sleeves import LookAtSleeves
from .patience import patient
from .tuning import DRESSING

LOW = (Reason.SLEEVE_LOW, Reason.SLEEVE_MISSED)  # below the elbow the cuff does not show all round the arm
UNSEEN = (Reason.ARM_LOST, Reason.NOTHING_SEEN)
# From the head of the bed a worn cuff showed 8 % of the way round its arm ten times in turn (290): asked from beside.
HOWEVER_LITTLE = CheckSleeveTuning(min_cuff_at=-1.0, min_share_round=0.0, min_covered=0.0, min_outer_covered=0.0)
BOTH_ALIKE = CheckSleeveTuning(before_counts=0.5)  # one is right where the other one is off by 0.1 (156)

# What shows too little of itself is left as it lies at first: laid by a guess, it came from 0.02 to 0.15 m aside (101).
NEAT = CheckCollarTuning(
    min_shown=DRESSING.collar_shown,
    max_aside=DRESSING.collar_aside,
    max_headward=DRESSING.collar_headward,
    max_footward=DRESSING.collar_footward,
    min_told=DRESSING.collar_told,
    min_told_from_head=DRESSING.collar_told_from_head,
)
# Over the face it does not stay (178), nor where it was looked at again and told as little: 0.10 and 0.06 m aside, seen
# there by each hand in another place, it was looked at 10 and 20 times more (195, 192).
HOWEVER_SEEN = replace(NEAT, min_shown=0.0)


def spread(context: Context) -> Stage:
    """The stage `spread`: both sleeves up, the collar in the middle, the chest covered.

    From beside the bed the robot sees that the arm that was dressed last lies.  The gown is put straight from its head,
    from where both hands reach both shoulders and the whole collar shows; from there the hands' cameras see in the end
    that both arms lie inside their sleeves, else the robot goes beside the bed to see it.
    """
    bed = Scope(context, "gown")
    return timed_stage(
        "spread",
        patient(bed, arm_lies(context, "left")),
        right_from_head(context, bed),
        surely_neat(context, bed),
        patient(bed, chest_looks_right(context)),
        seconds=DRESSING.spread_timeout,
    )


def go_to_head(scope: Scope) -> list[Behaviour]:
    """To the head of the bed, from where both hands reach both shoulders and the whole collar shows."""
    return [Navigate("go round to the head", scope, goal="bed_head"), go_up(scope)]


def go_up(scope: Scope) -> Navigate:
    """To where both hands reach both shoulders; where the robot stands there, it stays."""
    return Navigate("go up", scope, goal=stance_at_head())


def arm_lies(context: Context, side: Side) -> Behaviour:
    """From beside it, see that an arm lies: lowered later, it would draw its sleeve down again.

    One that is hidden for now is looked for again by whatever needs it next, and lowered in the end as any other (229).
    """
    arm = arm_scope(context, f"{side} sleeve", side)
    lies = sequence(
        f"the {side} arm lies",
        *go_beside(arm, side),
        put_down("first", arm),
        not_slipped(arm, DRESSING.armhole_slipped),
        back_off("leave", arm, DRESSING.back_off_distance),
    )
    later = back_off("leave it for now", arm, DRESSING.back_off_distance)
    return fallback(f"the {side} arm lies, or later", lies, later)


def right_from_head(context: Context, bed: Scope) -> Behaviour:
    """See from the head of the bed, which is next anyhow, that the first sleeve is up its arm; else go beside it first.

    The way round the foot of the bed to it takes half a minute, and 4 of 6 first sleeves were up far enough (166 to
    171).
    """
    arm = arm_scope(context, "from head", "right")
    up = CheckSleeve("up by now", arm, min_reach=DRESSING.armhole_slipped, must_show=True, tuning=FROM_HEAD)
    seen = sequence("seen up from the head", *go_to_head(arm), LookAtPerson("look", arm), patient(arm, up))
    from_beside = sequence(
        "the right arm from beside it",
        patient(bed, arm_lies(context, "right")),
        Navigate("go round to the head", bed, goal="bed_head"),
    )
    return fallback("the right arm, or from beside it", seen, from_beside)


def surely_up(context: Context, bed: Scope, side: Side) -> Behaviour:
    """Where no close look told it surely, see from beside the bed that a sleeve is up; else it is drawn up alone.

    The collar, laid after both were drawn up, takes the right sleeve down again by up to 0.1, which hardly shows from
    the head of the bed (155, 156).  Drawn up alone, it mostly leaves the collar where it is; that is seen, and set
    right.
    """

    def once_more() -> Behaviour:
        anew = Scope(context, f"{side} alone")
        face = CheckFace("the face is free", anew)
        covered = {Reason.FACE_COVERED: lambda: straight(Scope(anew, "face"), HOWEVER_SEEN)}
        drawn = sequence(
            f"{side} sleeve once more",
            *go_to_head(anew),
            drawn_alone(anew, side),
            RecoverBy(f"{anew.prefix}until the face is free", face, covered, attempts=2),
            straight(anew),
            *closely(anew, "about the middle"),
            look_at_sleeves(anew),
        )
        return patient(anew, drawn)

    seen, (surely, likely) = seen_from_head(bed, side), DRESSING.armhole_beside_alone
    # one that looks low from beside alone is drawn up once more; then the mean of both looks tells (0)
    sure = patient(bed, still_inside(context, side, seen, "still", surely))
    low = {Reason.SLEEVE_LOW: once_more}
    drawn = RecoverBy(f"until the {side} sleeve is up", sure, low, attempts=DRESSING.alone_attempts)
    told = patient(bed, still_inside(context, side, seen, "then", likely))
    sleeve = arm_scope(context, f"{side} sleeve worn", side)
    worn = CheckWorn("sits", sleeve, min_reach=DRESSING.armhole_closely)
    return fallback(f"the {side} sleeve up, as told by both", worn, drawn, told)


def drawn_alone(gown: Scope, side: Side) -> Behaviour:
    """Draw up one sleeve; where it gets no farther, it may do."""
    seat = (SeatSleeves("seat", gown, side=side), back_off("draw back from it", gown))
    left = surely_back("leave it as it is", gown)
    return fallback(f"{gown.prefix}as far as it goes", sequence(f"{gown.prefix}draw it up", *seat), left)


def seen_from_head(bed: Scope, side: Side) -> Key:
    """How far up a sleeve was seen from the head of the bed."""
    return bed.key(f"{side}_seen_from_head")


def surely_neat(context: Context, bed: Scope) -> Behaviour:
    """Worn neatly, as seen from the head of the bed, and both sleeves up, as seen closely or from beside it.

    A collar that one of them took along is laid in the middle once more, and all of it is seen anew.
    """

    def laid_once_more() -> Behaviour:
        anew = Scope(bed, "anew")
        return sequence("lay the collar once more", *go_to_head(anew), laid_in_the_middle(anew))

    up = (surely_up(context, bed, side) for side in SIDES[::-1])
    both = sequence("neat", patient(bed, neaten(context, bed)), *up)
    # a sleeve that comes no higher alone, or whose collar does not stay meanwhile, is drawn up with the other one (186)
    unsure: dict[Reason, Callable[[], Behaviour]] = {
        Reason.COLLAR_ASIDE: laid_once_more,
        Reason.SLEEVE_LOW: laid_once_more,
    }
    return RecoverBy("until it is surely neat", both, unsure, attempts=DRESSING.surely_neat_attempts)


def neaten(context: Context, bed: Scope) -> Behaviour:
    """From the head of the bed, see whether the gown is worn neatly; what is not so is set right, and seen anew.

    A collar that lies over the face comes before all else.  A front that shows its inside is drawn flat then, as that
    draws sleeves down.  The collar's middle comes last: while a sleeve is low, half of the neckline is out of sight,
    and drawing both up takes the collar along.  Cloth springs back in part, so what did not do is done once more, from
    where it lies by then.  Each state is looked at once: sleeves that are looked at from beside, before they are drawn
    up and after, cost half a minute each time (257 to 260).
    """
    sleeves = [shown(context, f"{side} armhole", side, seen_from_head(bed, side)) for side in SIDES]
    middle = closely(bed, "the collar lies in the middle")
    flat_first = Condition("no fold shows", outside_out, Reason.WRONG_SIDE)
    flat_now = Condition("nothing is folded over", outside_out, Reason.WRONG_SIDE)
    face_free = CheckFace("the face is free", bed)
    # drawn up, a sleeve beside its arm stays there, and takes the collar along (141): that arm is dressed again
    closer = (look_at_sleeves(bed), Condition("no sleeve beside its arm", none_seen_beside, Reason.SLEEVE_BESIDE))
    seen = sequence("seen to be neat", go_up(bed), face_free, flat_first, *closer, *sleeves, *middle, flat_now)

    def set_right() -> Behaviour:
        return sequence("draw up and straighten", seated(bed), straight(Scope(bed, "then")))

    set_right_by: dict[Reason, Callable[[], Behaviour]] = {
        Reason.FACE_COVERED: lambda: straight(Scope(bed, "off the face"), HOWEVER_SEEN),
        Reason.WRONG_SIDE: lambda: unfolded(context, bed),
        **dict.fromkeys(LOW, set_right),
        Reason.COLLAR_ASIDE: lambda: straight(Scope(bed, "collar")),
        **dict.fromkeys(UNSEEN, lambda: looked_again(context, bed)),
    }
    return RecoverBy("until it is neat", seen, set_right_by, attempts=DRESSING.neaten_attempts)


def unfolded(context: Context, bed: Scope) -> Behaviour:
    """Go beside the bed and draw a front flat that shows its inside in a fold; then the sleeves may be low.

    A collar that is folded back over itself is not there to be taken, nine times in turn (0): then both sleeves are
    drawn up from the head, which takes it along.
    """
    front = arm_scope(context, "fold", "left")
    beside = Navigate("go beside it", front, goal="bed_left")
    none = Condition("no fold is left", outside_out, Reason.WRONG_SIDE)
    rest = fallback("the rest of it", none, seated(Scope(bed, "folded")))
    return sequence("unfold it", beside, flat(front), *go_to_head(front), rest)


def looked_again(context: Context, bed: Scope) -> Behaviour:
    """See from beside that both sleeves are on their arms, which may not be known any more, and lay the collar.

    However little of it shows: it looked no different the next time.
    """

    def on_its_arm(side: Side) -> list[Behaviour]:
        arm = arm_scope(context, f"{side} arm again", side)
        return [*go_beside(arm, side), CheckSleeve("is on it", arm, must_show=True, tuning=FROM_HEAD)]

    again = Scope(bed, "again")
    arms = [node for side in SIDES for node in on_its_arm(side)]
    return sequence("both arms again", *arms, *go_to_head(again), straight(again, HOWEVER_SEEN))


def closely(gown: Scope, name: str, tuning: CheckCollarTuning = NEAT) -> list[Behaviour]:
    """Look at the collar with both hands' cameras, and judge it by that."""
    return [look_closely(gown, name), CheckCollar(name, gown, tuning=tuning)]


def look_closely(gown: Scope, name: str) -> Behaviour:
    """Look with both hands' cameras; where they are in each other's way, or something is, the head's camera tells."""
    as_it_is = back_off(f"back: {name}", gown)
    return fallback(f"{gown.prefix}look: {name}", LookAtCollar(f"{name}?", gown), as_it_is)


def look_at_sleeves(gown: Scope) -> Behaviour:
    """Look with both hands' cameras how far up the sleeves are; where they do not get there, other looks tell."""
    return fallback(
        f"{gown.prefix}look at both sleeves", LookAtSleeves("sleeves?", gown), back_off("as they are", gown)
    )


def sleeves_by_now(gown: Scope) -> Behaviour:
    """Look at both sleeves once more if the gown was touched since.

    From the head alone a left one that was up was told too low after the gown had been drawn over, and drawn (106).
    """
    known = Condition(f"{gown.prefix}sleeves known", sleeves_known, Reason.NOTHING_SEEN)
    return fallback(f"{gown.prefix}how they sit by now", known, look_at_sleeves(gown))


def over(bed: Scope) -> Behaviour:
    """Draw a gown that lies to one side over; where it cannot be done, the rest may do."""
    gown = Scope(bed, "over")
    drawn = sequence(f"{gown.prefix}draw it over", DrawOver("draw over", gown), back_off("clear the view", gown))
    return fallback(f"{gown.prefix}over the middle", drawn, surely_back("leave it", gown))


def seated(bed: Scope) -> Behaviour:
    """Draw up sleeves that are low, the gown to the middle first; where they get no farther, they may do anyhow."""
    gown = Scope(bed, "sleeves")
    # from the head of the bed: where a sleeve was seen to be low from beside it, the robot stands there
    draw = SeatSleeves("seat", gown, up=DRESSING.armhole_closely)
    seat = (go_up(gown), over(gown), sleeves_by_now(gown), draw, back_off("clear the view", gown))
    left = sequence("left as they are", surely_back("leave them", gown), go_up(Scope(gown, "left")))
    return fallback("as far as they go", sequence("draw them up", *seat), left)


def laid_in_the_middle(gown: Scope) -> Behaviour:
    """Take the collar and lay it in the middle."""
    lay = (Spread("spread", gown), back_off("clear the view", gown))
    return sequence(f"{gown.prefix}by its collar", look_closely(gown, "where is it"), *lay)


def straight(gown: Scope, neat: CheckCollarTuning = NEAT) -> Behaviour:
    """Draw a collar that lies aside over with the front, then lay it straight; where it gets no nearer, it may do.

    Laid in the middle alone, a collar that both sleeves had drawn 0.12 m aside went back to 0.08 m; with the front it
    stayed at 0.02 m (0).  One that lies headward sprang back 6 times of 16, so there are two tries.
    """

    def straighten() -> Behaviour:
        by_now = sequence(f"{gown.prefix}by now", *closely(gown, "straight by now", neat))
        rest = fallback(f"{gown.prefix}straight", by_now, laid_in_the_middle(gown))
        return sequence(f"{gown.prefix}lay it straight", over(gown), rest)

    lies = sequence(f"{gown.prefix}lies", *closely(gown, "lies straight", neat))
    laid = RecoverBy(f"{gown.prefix}until it is straight", lies, {Reason.COLLAR_ASIDE: straighten}, attempts=3)
    return fallback(f"{gown.prefix}as straight as may be", laid, surely_back("leave it", gown))


def shown(context: Context, name: str, side: Side, seen: Key) -> Behaviour:
    """See from the head of the bed whether a sleeve is up far enough; where no close look told it low, from beside it.

    From the head alone, sleeves that hide behind a shoulder did not show in any of six rounds (215, 233, 238), and ones
    that were up were drawn up again, which took the collar aside (126, 198).
    """
    sleeve = arm_scope(context, name, side)
    closely = Scope(sleeve, "by")

    up, near = DRESSING.armhole_up, DRESSING.armhole_closely
    sits = CheckSleeve("sits", sleeve, min_reach=up, min_closely=near, must_show=True, tuning=FROM_HEAD, reach=seen)
    not_low = Condition(f"{sleeve.prefix}not seen low", none_seen_low, Reason.SLEEVE_LOW)
    may_sit = CheckSleeve(
        "may sit", sleeve, min_reach=DRESSING.armhole_may_sit, min_closely=near, tuning=HOWEVER_LITTLE, reach=seen
    )
    sits_after_all = CheckSleeve(
        "sits after all",
        closely,
        min_reach=DRESSING.armhole_beside,
        seen_before=seen,
        min_together=DRESSING.armhole_together,
        min_closely=near,
        must_show=True,
        tuning=FROM_HEAD,
    )
    from_head = sequence(f"{sleeve.prefix}from the head", LookAtPerson("look", sleeve), sits)
    from_beside = sequence(
        f"{sleeve.prefix}from beside it",
        not_low,
        may_sit,
        *go_beside(closely, side),
        sits_after_all,
    )
    return sequence(f"{sleeve.prefix}up", fallback(f"{sleeve.prefix}seen", from_head, from_beside), go_up(sleeve))


def still_inside(context: Context, side: Side, seen: Key, when: Literal["still", "then"], min_now: float) -> Behaviour:
    """Look from beside the bed whether the arm lies, inside its sleeve, which is up: its cuff shows all round it there.

    From beside the shoulder a cuff showed 42 % of the way round, and a run that was dressed ended (0).
    """
    sleeve = arm_scope(context, f"{side} cuff" if when == "still" else f"{side} cuff then", side)
    return sequence(
        f"the {side} arm is {when} inside",
        Navigate("go round to see it", sleeve, goal=f"bed_{side}"),
        LookAtPerson("look", sleeve),
        LowerArm("lies", sleeve, hand=sleeve["pulling"]),
        CheckSleeve(
            "is inside",
            sleeve,
            seen_before=seen,
            min_together=DRESSING.armhole_surely,
            min_now=min_now,
            min_closely=DRESSING.armhole_closely,
            tuning=BOTH_ALIKE,
        ),
    )


def chest_looks_right(context: Context) -> Behaviour:
    """Look at the trunk: covered, the outside out."""
    return sequence(
        "the chest",
        LookAtPerson("look at the chest", Scope(context, "chest", side="right"), part="trunk"),
        Condition("the chest is covered", chest_covered, Reason.NOTHING_SEEN),
        Condition("the outside is out", outside_out, Reason.WRONG_SIDE),
    )


def chest_covered(context: Context) -> bool:
    """The head camera sees gown on most of the trunk."""
    return _cover(context).share > DRESSING.covered_share


def outside_out(context: Context) -> bool:
    """The head camera sees hardly any of the gown's inside on the trunk: nothing of it is folded over."""
    return _cover(context).outside > DRESSING.outside_share


def sleeves_known(context: Context) -> bool:
    """Both sleeves were looked at closely since the gown was touched."""
    return len(context.memory.of(CloseLook, CloseLook).sleeves) == len(SIDES)


def none_seen_low(context: Context) -> bool:
    """No close look since the gown was touched has told that a sleeve is low: what else is seen of them tells."""
    seen = context.memory.of(CloseLook, CloseLook).sleeves.values()
    return all(sleeve.reach >= DRESSING.armhole_closely for sleeve in seen)


def none_seen_beside(context: Context) -> bool:
    """No close look since the gown was touched has told that a cuff has no arm in it."""
    seen = context.memory.of(CloseLook, CloseLook).sleeves.values()
    return all(sleeve.round_arm >= DRESSING.cuff_beside for sleeve in seen)


def _cover(context: Context) -> ChestCover:
    """How the gown covers the trunk, which lies where the map's bed says."""
    bed = context.world.room.bed
    shoulders = np.array((*bed[:, :2].mean(axis=0), bed[1, 2])) + DRESSING.shoulders_on_bed
    return context.senses.chest_cover(context.world.look("head"), shoulders_in_map=shoulders)
