"""One arm into its sleeve, and what the stages `dress` and `spread` share for that.

over the hand    stand, lift the arm, take the sleeve by its strap, hold it open before the hand, pull it past the
                 wrist, lower the arm and let it go
to the shoulder  pull on; where that fails, with a new hold of the sleeve, which stays on the arm
inside?          back off, put the arm down and look, once more from beside its shoulder; whatever went wrong until
                 here, a held arm is put down, a stray sleeve, or one under which the arm lies, is laid out by the
                 hand, or fetched from the other side of the bed, and all begins again
"""

from __future__ import annotations

from collections.abc import Callable

from py_trees.behaviour import Behaviour

from ....sim.world import SIDES, Side
from ....skills.belief.refused_stands import RefusedStands
from ....skills.carry_sleeve import CarrySleeve
from ....skills.check_laid_out import CheckLaidOut
from ....skills.check_sleeve import CheckSleeve, CheckSleeveTuning
from ....skills.control.lowering import LoweringTuning
from ....skills.core.context import Context
from ....skills.core.reasons import Reason
from ....skills.core.scope import Scope
from ....skills.find_stand import FindStand
from ....skills.geometry.stances import LIFTING, PULLING, Stand, stance
from ....skills.grasp_sleeve import GraspSleeve
from ....skills.lay_sleeve import LaySleeve
from ....skills.lift_arm import LiftArm
from ....skills.look_at_person import LookAtPerson
from ....skills.look_for_sleeve import LookForSleeve
from ....skills.lower_arm import LowerArm
from ....skills.navigate import Navigate
from ....skills.present_sleeve import PresentSleeve
from ....skills.pull_along_arm import PullAlongArm
from ....skills.release_arm import ReleaseArm, ReleaseArmTuning
from ....skills.retreat import Retreat
from ...nodes.composers import fallback, sequence
from ...nodes.condition import Condition
from ...nodes.decorators import RecoverBy
from .check_over_hand import CheckOverHand
from .draw_flat import FLAT, DrawFlat, DrawFlatTuning
from .patience import FOR_A_MOMENT, patient, sight_again, unhurried
from .take_down import fingers_closed
from .tuning import DRESSING, SECOND_SLEEVE, SleeveTuning

STUCK = (Reason.MOTION_BLOCKED, Reason.SLEEVE_CAUGHT, Reason.CLOTH_SLIPPED, Reason.FORCE_LIMIT)
LOST = (Reason.ARM_LOST, Reason.ARM_SLIPPED, Reason.GRASP_MISSED, Reason.NOTHING_SEEN, Reason.UNREACHABLE)
MISSES = (
    *STUCK,
    *LOST,
    *FOR_A_MOMENT,
    Reason.SLEEVE_MISSED,
    Reason.SLEEVE_FOLDED,
    Reason.SLEEVE_LOW,
    Reason.TIMEOUT,
    Reason.PERSON_MOVED,
)

# Seen from the head of the bed, cuffs of arms inside them show 17 to 58 % of the way round (101, 103); whether an arm
# is inside is looked at from beside it.  Skin of the shoulder shows there beside the neckline of 3 dressed people of 8.
FROM_HEAD = CheckSleeveTuning(min_share_round=0.1, min_covered=0.0, min_outer_covered=0.0)


def arm_scope(context: Context, name: str, side: Side) -> Scope:
    """What leaves at one of the person's arms share: whose arm, which hand does what, how the strap is held."""
    return Scope(context, name, keys=("grip",), side=side, lifting=LIFTING[side], pulling=PULLING[side])


def worn_already(arm: Scope) -> CheckSleeve:
    """From beside the bed, see that a sleeve is on its arm, above the elbow: one that is low is drawn up later."""
    return CheckSleeve("worn already", arm, must_show=True)


def dress_arm(
    context: Context,
    side: Side,
    sleeve: SleeveTuning,
    *,
    name: str | None = None,
    attempts: int = DRESSING.arm_attempts,
    worth: Callable[[], Behaviour] | None = None,
) -> Behaviour:
    """One arm into its `sleeve`, from beside the bed; its leaves are called by the arm, or by `name`.

    It is begun again where its sleeve was found and it is `worth` it, of which nobody is asked where the person has
    moved.
    """
    arm = arm_scope(context, name or f"{side} arm", side)

    def grasp_again() -> Behaviour:
        return sequence(
            "take the sleeve on",
            back_off("let the strap go", arm),
            Navigate("stand there again", arm, goal=stance(side, "lift")),
            LookAtPerson("look from there", arm),
            grasp_worn("grasp the worn sleeve", arm),
        )

    as_it_is = sequence(
        f"{side} sleeve as it is",
        CheckOverHand("over the hand already", arm),
        Navigate("go where it sits", arm, goal=stance(side, "lift")),
        LookAtPerson("look where it sits", arm),
        grasp_worn("take it as it sits", arm),
    )

    def begin_again(scope: Scope, free: Callable[[Scope], Behaviour]) -> Behaviour:
        return sequence(
            f"{scope.prefix}begin again",
            let_down("held", scope, "lifting", other="pulling"),
            free(scope),
            sight_again(scope, "then")(),
            fallback(
                f"{scope.prefix}arm and sleeve laid out",
                CheckOverHand("over the hand by now", scope),
                CheckLaidOut("bare, its sleeve at hand", scope),
                lay_out(scope),
                off_trunk(scope, side),
                fetch_sleeve(scope, side),
                back_off("leave it as it lies", scope),
            ),
        )

    up = RecoverBy(
        "up to the shoulder",
        up_arm(arm, sleeve.pull_load),
        dict.fromkeys(STUCK, grasp_again) | {Reason.ARM_LOST: lambda: LookAtPerson("look again", arm)},
        attempts=2,
    )
    # an arm that is inside a sleeve that goes no farther is not begun again: the last stage draws it up (279)
    far = fallback(f"{side} sleeve as far as it goes", up, let_go(Scope(arm, "so far")))
    # a hand that met the arm as it drew back is no reason to take the sleeve off again (291)
    away = surely_back("back off", arm, DRESSING.back_off_distance)
    # seen to be beside its arm from where the robot drew back to, one that was on it was taken off again (195); from
    # beside the shoulder all of 161 that sat on their arms were told.  One that did not show at all lay beside its arm
    # under a fold, and ten rounds of the last stage never saw it (185); one that came up freely, and not far, had no
    # arm in it (138, 193)
    doubtful = (Reason.SLEEVE_MISSED, Reason.NOTHING_SEEN, Reason.SLEEVE_LOW)
    inside = RecoverBy(
        f"{side} arm inside its sleeve",
        patient(arm, CheckSleeve("is inside", arm, must_show=True, pulled=True)),
        dict.fromkeys(doubtful, lambda: sequence(f"{side} arm once more", *go_beside(Scope(arm, "surely"), side))),
    )
    lies = patient(arm, put_down("in the end", arm))
    once = sequence(
        f"{side} arm once", fallback(f"{side} hand inside", as_it_is, over_hand(arm, sleeve)), far, away, lies, inside
    )

    def missed() -> Behaviour:
        found = Condition(f"{arm.prefix}its sleeve was found", sleeve_was_found, Reason.NOTHING_SEEN, side=side)
        asked = [found] if worth is None else [found, worth()]
        return sequence(f"{arm.prefix}worth another try", *asked, begin_again(Scope(arm, "again"), laid_back))

    again: dict[Reason, Callable[[], Behaviour]] = {
        **dict.fromkeys(MISSES, missed),
        Reason.PERSON_MOVED: lambda: begin_again(arm, let_go),  # whoever moves is let go of at once
    }
    return RecoverBy(f"dress the {side} arm", once, again, attempts=attempts)


def sleeve_was_found(context: Context, side: Side) -> bool:
    """A sleeve was not missed or out of sight from too many places since it was laid there.

    With the gown on the floor, an arm was lifted six times (103).
    """
    return len(context.memory.of(RefusedStands, RefusedStands).poses.get(side, ())) < DRESSING.refused_stands


def over_hand(arm: Scope, sleeve: SleeveTuning) -> Behaviour:
    """Until the sleeve is past the wrist and the arm is let go."""
    held, stand = Scope(arm, keys=("hold",)), arm.key("stand")

    def grasp(name: str) -> Behaviour:
        return GraspSleeve(name, held, hand=arm["pulling"])

    def lay(why: str) -> Behaviour:
        down = LaySleeve(f"{why}, lay it down", held, hand=arm["pulling"])
        return sequence(f"{why}, laid down", down, grasp(f"{why}, take it again"))

    def opened(name: str, why: str) -> Behaviour:
        limits = {"max_load": sleeve.carry_load, "min_cuff_distance": sleeve.min_cuff_distance}
        present = PresentSleeve(name, held, **limits)
        return RecoverBy(f"{name}, opened", present, {Reason.SLEEVE_FOLDED: lambda: lay(why)}, attempts=3)

    def missed() -> Behaviour:
        # held out once more as it hung, it went past the hand again, 4 times of 5, each time farther off the bed (193);
        # folded then, its cuff no farther out than the armhole, it missed the hand five times of five (184, 185, 193)
        return sequence("laid down, and held out again", lay("missed"), opened("present it again", "still folded"))

    pull = PullAlongArm("pull over the hand", held, grip_goal=DRESSING.past_wrist)
    lowering = LoweringTuning(spread=DRESSING.lowered_spread, friction=DRESSING.lowered_friction)
    spread_out = {"lower": True, "tuning": ReleaseArmTuning(lowering=lowering)}
    return sequence(
        "over the hand",
        Navigate("come to it", arm, goal=stance(arm["side"], "lift")),
        arm_in_view(arm),
        LookForSleeve("look for the sleeve", arm, hand=arm["pulling"]),
        FindStand("choose where to stand", arm, stand=stand),
        Navigate("stand there", arm, goal=stand),
        LiftArm("lift", held, hand=arm["lifting"]),
        grasp("grasp the sleeve"),
        opened("present the sleeve", "folded"),
        RecoverBy("until the hand is inside", pull, {Reason.SLEEVE_MISSED: missed}, attempts=3),
        RecoverBy(
            f"{arm.prefix}until it lies",
            ReleaseArm("lower it and let go", arm, hand=arm["lifting"], ready="if possible", **spread_out),
            # met by the hand that lowers it, an arm whose sleeve is over the hand is lowered on, not begun again (5)
            {Reason.FORCE_LIMIT: lambda: ReleaseArm("lower it on", arm, hand=arm["lifting"], **spread_out)},
        ),
    )


def arm_in_view(arm: Scope) -> Behaviour:
    """See the arm, from farther off where it is lost: near it, a hand beyond the cloth is out of the picture."""
    far = Scope(arm, "far")

    def farther_off() -> Behaviour:
        return sequence(
            f"{far.prefix}from farther off",
            Navigate("go off", far, goal=f"bed_{arm['side']}"),
            LookAtPerson("look", far),
            Navigate("come back", far, goal=stance(arm["side"], "lift")),
        )

    return RecoverBy(f"{arm.prefix}in view", LookAtPerson("look", arm), {Reason.ARM_LOST: farther_off})


def up_arm(arm: Scope, max_load: float) -> PullAlongArm:
    """To the shoulder, drawn as hard as `max_load` [N]; let go of as it is.

    Drawn farther towards the head, tucked behind the shoulder or slackened before it was let go of, the strap took the
    collar off the middle or the armhole down the arm (docs/dressing-findings.md).
    """
    goal = {"grip_goal": DRESSING.grip_goal, "armhole_goal": DRESSING.armhole_goal}
    return PullAlongArm("pull up", arm, stand=stance(arm["side"], "shoulder"), max_load=max_load, **goal)


def let_down(name: str, arm: Scope, hand: str, *, other: str | None = None) -> Behaviour:
    """A hand that holds the arm lowers it, once more when the `other` one has let its sleeve go; in the end it opens.

    A sleeve that was caught on the arm kept it 0.23 m up (134).
    """
    held = Scope(arm, name, hand=arm[hand])
    ways: list[Behaviour] = [unhurried(held, ReleaseArm("lower", held, lower=True))]
    if other is not None:
        free = unhurried(held, Retreat("let it go", held, hands=arm[other], ready="never"))
        then = unhurried(held, ReleaseArm("lower then", held, lower=True))
        ways.append(sequence(f"{held.prefix}without it", free, then))
    return fallback(f"{held.prefix}let down", *ways, unhurried(held, ReleaseArm("open", held)))


def put_down(name: str, arm: Scope) -> Behaviour:
    """An arm that is up and that nobody holds is swung down: from where the robot stands, else from beside the arm.

    One that is not where it was taken to be, as its owner has moved since, may be seen to lie from farther off.
    """
    free = Scope(arm, name)
    return fallback(
        free.prefix + "put it down",
        sequence(
            free.prefix + "from here",
            LookAtPerson("look", free),
            LowerArm("lower", free, hand=arm["pulling"]),
        ),
        sequence(
            free.prefix + "from beside it",
            let_down("let go", free, "pulling"),
            Navigate("go there", free, goal=stance(arm["side"], "lift")),
            LookAtPerson("look there", free),
            LowerArm("lower there", free, hand=arm["lifting"]),
        ),
        sequence(
            free.prefix + "from farther off",
            back_off("step back", free, DRESSING.back_off_distance),
            LookAtPerson("look from there", free),
            LowerArm("lower from there", free, hand=arm["pulling"]),
        ),
    )


def let_go(arm: Scope) -> Behaviour:
    """Of all that is held, where it is."""
    return unhurried(arm, back_off("free hands", arm))


def hands_freed(arm: Scope) -> list[Behaviour]:
    """Put down what is held at an arm: the arm, then its sleeve."""
    return [let_down("held", arm, "lifting", other="pulling"), laid_back(arm)]


def laid_back(arm: Scope) -> Behaviour:
    """A sleeve that is still held is laid on the bed: let go of in the air, it took the gown to the floor (138, 193).

    It may weigh little, as the bed carries the rest.
    """
    held = Condition(f"{arm.prefix}still held", fingers_closed, Reason.CLOTH_SLIPPED, hand=arm["pulling"])
    laid = patient(arm, LaySleeve("lay it back", arm, hand=arm["pulling"]))
    return fallback(
        f"{arm.prefix}the sleeve let go",
        sequence(f"{arm.prefix}laid back", held, laid, let_go(Scope(arm, "laid"))),
        let_go(arm),
    )


def go_beside(sleeve: Scope, side: Side) -> list[Behaviour]:
    """To beside a shoulder, the arm in view."""
    return [
        Navigate("go round to its side", sleeve, goal=f"bed_{side}"),
        Navigate("go up to it", sleeve, goal=stance(side, "shoulder")),
        LookAtPerson("go up and look", sleeve),
    ]


def not_slipped(arm: Scope, least: float, *, pulls: int = 2) -> Behaviour:
    """A sleeve below `least` of the upper arm is pulled up by its strap again, `pulls` times; then the rest may do."""

    def pulled_up() -> Behaviour:
        return sequence(
            f"{arm.prefix}up again",
            Navigate("go where it is", arm, goal=stance(arm["side"], "lift")),
            grasp_worn("take it once more", arm),
            up_arm(arm, SECOND_SLEEVE.pull_load),
            back_off("let it go", arm, DRESSING.back_off_distance),
            *go_beside(Scope(arm, "then"), arm["side"]),
        )

    up = sequence(
        f"{arm.prefix}seen up",
        LookAtPerson("look along it", arm),
        CheckSleeve("up the arm", arm, min_reach=least, tuning=FROM_HEAD),
    )
    again = RecoverBy(f"{arm.prefix}not slipped", up, {Reason.SLEEVE_LOW: pulled_up}, attempts=1 + pulls)
    return fallback(f"{arm.prefix}as it may be", patient(arm, again), back_off("leave it so", arm))


def lay_out(arm: Scope) -> Behaviour:
    """Take the sleeve by its strap, wherever it is, and lay it beyond the hand: the gown comes along, off the arm."""

    def take(stand: Stand) -> Behaviour:
        go = Navigate(f"go to {stand} stance", arm, goal=stance(arm["side"], stand))
        return sequence(f"{arm.prefix}from {stand} stance", go, grasp_worn(f"grasp at {stand} stance", arm))

    return sequence(
        "lay the sleeve out",
        fallback("take the stray sleeve", take("lift"), take("shoulder")),
        LaySleeve("lay it beyond the hand", arm, hand=arm["pulling"]),
        back_off("leave the sleeve there", arm),
    )


def at_hand(arm: Scope) -> Behaviour:
    """Before an arm is lifted, carry its sleeve out where it cannot be taken, or covers the arm; else it may do.

    One that hangs over the edge of the bed is taken from beside: no hand comes down to it (180).  One that is out of
    reach from this side is fetched from the other one: drawn back over the midline as the first sleeve was pulled up
    once more, it cost two lifts and a minute and a half (195).
    """
    side = arm["side"]
    return fallback(
        f"the {side} sleeve at its hand",
        carried_across("it", arm, side, own_side=True),
        sequence(f"the {side} sleeve from beside", back_off("draw back", arm), lay_out(arm)),
        fetch_sleeve(arm, side),
        back_off("leave it there", arm),
    )


def off_trunk(arm: Scope, side: Side) -> Behaviour:
    """Carry a sleeve that lies on the trunk, or on the arm, out to beyond the hand: taken from above."""
    return sequence(
        f"the {side} sleeve out of the way",
        back_off("make room", arm),
        Navigate("go to carry it out", arm, goal=f"bed_{side}"),
        carried_across("it", arm, side, own_side=True),
        Navigate("go back from there", arm, goal=f"bed_{side}"),
    )


def fetch_sleeve(arm: Scope, side: Side) -> Behaviour:
    """From the other side of the bed, carry a sleeve back that lies there, and come back."""
    other = SIDES[1 - SIDES.index(side)]
    return sequence(
        f"the {side} sleeve from the other side",
        back_off("free the way", arm),
        Navigate("go to the other side", arm, goal=f"bed_{other}"),
        carried_across("it", arm, side),
        Navigate("go back to its side", arm, goal=f"bed_{side}"),
    )


def carried_across(name: str, scope: Scope, side: Side, *, own_side: bool = False) -> Behaviour:
    """A stray sleeve, from the other side of the bed; arms back, as no base drives on with a hand above the person."""
    how, clear = ("out", "off") if own_side else ("across", "clear of")
    across = CarrySleeve(f"carry {name} {how}", scope, side=side, own_side=own_side)
    return sequence(f"{scope.prefix}{name} to its side", patient(scope, across), back_off(f"{clear} {name}", scope))


def flat(front: Scope, tuning: DrawFlatTuning = FLAT) -> Behaviour:
    """From beside an arm, draw folds out of the gown's front; where it cannot be done, the rest may do."""
    draw = DrawFlat("draw flat", front, hand=front["pulling"], tuning=tuning)
    drawn = sequence(f"{front.prefix}draw it flat", draw, back_off("off the front", front))
    return fallback(f"{front.prefix}no folds", patient(front, drawn), back_off("leave the front", front))


def grasp_worn(name: str, arm: Scope) -> GraspSleeve:
    """Take hold of a sleeve that is over the hand, or up the arm."""
    return GraspSleeve(name, arm, hand=arm["pulling"], worn=True)


def back_off(name: str, scope: Scope, distance: float = 0.0) -> Retreat:
    """Let go, draw back by `distance` [m], arms ready if a way to that posture is found."""
    return Retreat(name, scope, base_distance=distance, ready="if possible")


def surely_back(name: str, scope: Scope, distance: float = 0.0) -> Behaviour:
    """As `back_off`, once more where a hand meets the person: left low, it met the shoulder again (193)."""
    here, on = (back_off(name, inner, distance) for inner in (scope, Scope(scope, "on")))
    return fallback(f"{scope.prefix}surely back", here, on)
