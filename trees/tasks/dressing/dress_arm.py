"""Half of the stage `dress`: one arm into its sleeve.

over the hand    stand, lift the arm, take the sleeve by its strap, hold it open before the hand, pull it past the
                 wrist, let the arm go
to the shoulder  pull on, seat; where that fails, with a new hold of the sleeve, which stays on the arm
inside?          back off and look; whatever went wrong until here, the arm is put down, a stray sleeve, or one under
                 which the arm lies, is laid out by the hand, and all begins again
"""

from __future__ import annotations

from collections.abc import Callable

from py_trees.behaviour import Behaviour

from ....sim.world import Side
from ....skills.check_laid_out import CheckLaidOut
from ....skills.check_sleeve import CheckSleeve
from ....skills.core.context import Context
from ....skills.core.ports import Key
from ....skills.core.reasons import Reason
from ....skills.find_stand import FindStand
from ....skills.geometry.stances import LIFTING, PULLING, Stand, stance
from ....skills.grasp_sleeve import GraspSleeve
from ....skills.lay_sleeve import LaySleeve
from ....skills.lift_arm import LiftArm
from ....skills.look_at_person import LookAtPerson
from ....skills.look_for_sleeve import LookForSleeve
from ....skills.navigate import Navigate
from ....skills.present_sleeve import PresentSleeve
from ....skills.pull_along_arm import PullAlongArm
from ....skills.release_arm import ReleaseArm
from ....skills.retreat import Retreat
from ....skills.seat_sleeve import SeatSleeve
from ...nodes.composers import fallback, sequence
from ...nodes.decorators import RecoverBy
from .tuning import DRESSING, SleeveTuning

MISSES = (
    Reason.SLEEVE_CAUGHT,
    Reason.CLOTH_SLIPPED,
    Reason.ARM_SLIPPED,
    Reason.GRASP_MISSED,
    Reason.ARM_LOST,
    Reason.NOTHING_SEEN,
    Reason.UNREACHABLE,
    Reason.MOTION_BLOCKED,
    Reason.FORCE_LIMIT,
    Reason.SLEEVE_MISSED,
    Reason.SLEEVE_FOLDED,
    Reason.TIMEOUT,
)
STUCK = (Reason.MOTION_BLOCKED, Reason.SLEEVE_CAUGHT, Reason.CLOTH_SLIPPED, Reason.FORCE_LIMIT)


def dress_arm(context: Context, arm: Side, sleeve: SleeveTuning) -> Behaviour:
    """One arm into its `sleeve`, from beside the bed."""

    def look(name: str) -> Behaviour:
        return LookAtPerson(f"{name} the {arm} arm", context, side=arm, posture=Key(f"{arm}_posture"))

    def let_go() -> Behaviour:
        put_down = fallback(
            f"put the {arm} arm down",
            ReleaseArm(f"lower the {arm} arm", context, hand=LIFTING[arm], lower=True),
            ReleaseArm(f"open the {arm} hold", context, hand=LIFTING[arm]),
        )
        return sequence(
            f"begin the {arm} arm again",
            put_down,
            back_off(context, f"free hands, {arm}", 0.0),
            fallback(
                f"{arm} arm and sleeve laid out",
                CheckLaidOut(f"the {arm} arm is bare, the sleeve at hand", context, side=arm),
                lay_out(context, arm),
                back_off(context, f"leave the {arm} arm as it lies", 0.0),
            ),
        )

    def take_on() -> Behaviour:
        return sequence(
            f"take the {arm} sleeve on",
            back_off(context, f"let the {arm} strap go", 0.0),
            Navigate(f"stand by the {arm} arm again", context, goal=stance(arm, "lift")),
            look("look from there at"),
            grasp_worn(context, arm, f"grasp the worn {arm} sleeve"),
        )

    once = sequence(
        f"dress the {arm} arm once",
        over_hand(context, arm, sleeve, look),
        RecoverBy(
            f"up to the {arm} shoulder",
            up_arm(context, arm, sleeve.pull_load),
            dict.fromkeys(STUCK, take_on) | {Reason.ARM_LOST: lambda: look("look again at")},
            attempts=2,
        ),
        back_off(context, f"back off from the {arm} arm", DRESSING.back_off_distance),
        CheckSleeve(f"the {arm} arm is inside", context, side=arm),
    )
    return RecoverBy(f"dress the {arm} arm", once, dict.fromkeys(MISSES, let_go), attempts=3)


def over_hand(context: Context, arm: Side, sleeve: SleeveTuning, look: Callable[[str], Behaviour]) -> Behaviour:
    """Until the sleeve is past the wrist and the arm is let go."""
    lifting, pulling = LIFTING[arm], PULLING[arm]
    hold, grip, stand = Key(f"{arm}_hold"), Key(f"{arm}_grip"), Key(f"{arm}_stand")

    def grasp(name: str) -> Behaviour:
        return GraspSleeve(name, context, side=arm, hand=pulling, hold=hold, grip=grip)

    def lay() -> Behaviour:
        return sequence(
            f"the {arm} sleeve is folded",
            LaySleeve(f"lay the {arm} sleeve down", context, grip=grip, hold=hold),
            grasp(f"grasp the {arm} sleeve again"),
        )

    def again() -> Behaviour:
        return PresentSleeve(
            f"bring the {arm} sleeve before the hand again",
            context,
            grip=grip,
            hold=hold,
            max_load=sleeve.carry_load,
        )

    present = PresentSleeve(
        f"bring the {arm} sleeve before the hand",
        context,
        grip=grip,
        hold=hold,
        max_load=sleeve.carry_load,
        min_cuff_distance=sleeve.min_cuff_distance,
    )
    pull = PullAlongArm(f"pull over the {arm} hand", context, grip=grip, hold=hold, grip_goal=DRESSING.past_wrist)
    return sequence(
        f"over the {arm} hand",
        Navigate(f"come to the {arm} arm", context, goal=stance(arm, "lift")),
        look("look at"),
        LookForSleeve(f"look for the {arm} sleeve", context, side=arm, hand=pulling),
        FindStand(
            f"choose where to stand by the {arm} arm", context, side=arm, lifting=lifting, pulling=pulling, stand=stand
        ),
        Navigate(f"stand by the {arm} arm", context, goal=stand),
        LiftArm(f"lift the {arm} arm", context, side=arm, hand=lifting, hold=hold),
        grasp(f"grasp the {arm} sleeve"),
        RecoverBy(f"until the {arm} sleeve opens", present, {Reason.SLEEVE_FOLDED: lay}, attempts=3),
        RecoverBy(f"until the {arm} hand is inside", pull, {Reason.SLEEVE_MISSED: again}, attempts=3),
        fallback(
            f"free the lifting hand, {arm}",
            ReleaseArm(f"let the {arm} arm go", context, hand=lifting, ready=True),
            ReleaseArm(f"leave the {arm} arm", context, hand=lifting),
        ),
    )


def lay_out(context: Context, arm: Side) -> Behaviour:
    """Take the sleeve by its strap, wherever it is, and lay it beyond the hand: the gown comes along, off the arm."""

    def take(stand: Stand) -> Behaviour:
        return sequence(
            f"take the {arm} sleeve from the {stand} stance",
            Navigate(f"go to the {stand} stance, {arm}", context, goal=stance(arm, stand)),
            grasp_worn(context, arm, f"grasp the stray {arm} sleeve, {stand} stance"),
        )

    return sequence(
        f"lay the {arm} sleeve out",
        fallback(f"take the stray {arm} sleeve", take("lift"), take("shoulder")),
        LaySleeve(f"lay the {arm} sleeve beyond the hand", context, grip=Key(f"{arm}_grip")),
        back_off(context, f"leave the {arm} sleeve there", 0.0),
    )


def grasp_worn(context: Context, arm: Side, name: str) -> GraspSleeve:
    """Take hold of a sleeve that is over the hand, or up the arm."""
    return GraspSleeve(name, context, side=arm, hand=PULLING[arm], worn=True, grip=Key(f"{arm}_grip"))


def up_arm(context: Context, arm: Side, max_load: float, again: str = "") -> Behaviour:
    """To the shoulder, drawn as hard as `max_load` [N]; names of the nodes begin with `again`."""
    grip = Key(f"{arm}_grip")
    return sequence(
        f"{again}pull up and seat, {arm}",
        PullAlongArm(
            f"{again}pull up to the {arm} shoulder",
            context,
            grip=grip,
            grip_goal=DRESSING.grip_goal,
            armhole_goal=DRESSING.armhole_goal,
            stand=stance(arm, "shoulder"),
            max_load=max_load,
        ),
        SeatSleeve(f"{again}seat the {arm} sleeve", context, grip=grip, max_load=DRESSING.seat_load_share * max_load),
    )


def back_off(context: Context, name: str, distance: float) -> Behaviour:
    """Let go, draw back by `distance` [m], arms ready; or as they are, where no way to the ready posture is found."""
    return fallback(
        name,
        Retreat(f"{name}, arms ready", context, base_distance=distance),
        Retreat(f"{name}, arms as they are", context, base_distance=distance, ready=False),
    )
