"""Stages C and D of the dressing tree, and what is owed whenever a stage fails.

C  dress the right arm, drive round the foot of the bed, dress the left arm
D  draw the collar to the neck on both sides
"""

from __future__ import annotations

import numpy as np
from py_trees.behaviour import Behaviour

from ..perception.estimates import Cover
from ..sim.world import SIDES, Side
from ..skills.bedside import LIFTING, PULLING, stance
from ..skills.context import Context
from ..skills.grasp_sleeve import GraspSleeve
from ..skills.lay_sleeve import LaySleeve
from ..skills.lift_arm import LiftArm
from ..skills.look_at_person import LookAtPerson
from ..skills.navigate import Navigate
from ..skills.ports import Key
from ..skills.present_sleeve import PresentSleeve
from ..skills.pull_along_arm import PullAlongArm
from ..skills.reasons import Reason
from ..skills.release_arm import ReleaseArm
from ..skills.retreat import Retreat
from ..skills.seat_sleeve import SeatSleeve
from ..skills.spread import Spread
from .composers import fallback, sequence
from .decorators import Condition, RecoverBy, Retry, Stage, Timeout

# Where a pull ends, beyond the shoulder [share of the upper arm]: the grip at the latest, the armhole where it is seen.
HEAD_END, SEAT = -0.45, -0.30
# How hard a sleeve is drawn on its way to the hand, and beyond the shoulder: enough to bring along the armhole's lower
# half; the second must not draw the first off its arm [N].
TAUT: dict[Side, float] = {"right": 4.0, "left": 1.8}
TAUT_ON: dict[Side, float] = {"right": 5.6, "left": 3.4}
# How far beyond the armhole the cuff shows at least, before a hand that came through.  In whole runs on seeds 0-8,
# sleeves that missed the hand showed -0.06 to 0.02, the others 0.09 to 0.12 on the right, 0.05 to 0.10 on the left [m].
OPENS: dict[Side, float] = {"right": 0.05, "left": 0.03}
SHOULDERS_ON_BED = np.array((0.0, -0.55, 0.10))  # of an adult, from the middle of the mattress [m]
COVERED = 0.75  # share of the trunk under cloth that counts as covered, as far as a camera can tell
PAST_WRIST = 1.5  # where the lifting hand may let go: the grip is half way up the forearm


def dress_arm(context: Context, arm: Side) -> Behaviour:
    """Half of stage C."""
    lifting, pulling = LIFTING[arm], PULLING[arm]
    hold, grip = Key(f"{arm}_hold"), Key(f"{arm}_grip")

    def look(name: str) -> Behaviour:
        return LookAtPerson(f"{name} the {arm} arm", context, side=arm, posture=Key(f"{arm}_posture"))

    def let_go(name: str) -> Behaviour:
        put_down = fallback(
            f"{name}: put the {arm} arm down",
            ReleaseArm(f"{name}: lower the {arm} arm", context, hand=lifting, lower=True),
            ReleaseArm(f"{name}: open the {arm} hold", context, hand=lifting))
        return sequence(f"{name}, {arm}", put_down, back_off(context, f"{name}: free hands, {arm}", 0.0))

    def grasp(name: str) -> Behaviour:
        return GraspSleeve(name, context, side=arm, hand=pulling, hold=hold, grip=grip)

    def again() -> Behaviour:
        return PresentSleeve(f"bring the {arm} sleeve before the hand again", context, grip=grip, hold=hold,
                             taut=TAUT[arm])

    lift_and_pull = sequence(
        f"lift and pull, {arm}",
        Navigate(f"stand by the {arm} arm", context, goal=stance(arm, "lift")),
        look("look at"),
        LiftArm(f"lift the {arm} arm", context, side=arm, hand=lifting, hold=hold),
        grasp(f"grasp the {arm} sleeve"),
        RecoverBy(f"until the {arm} sleeve opens", PresentSleeve(
            f"bring the {arm} sleeve before the hand", context, grip=grip, hold=hold, taut=TAUT[arm], opens=OPENS[arm]),
            {Reason.SLEEVE_FOLDED: lambda: sequence(
                f"the {arm} sleeve is folded",
                LaySleeve(f"lay the {arm} sleeve down", context, grip=grip, hold=hold),
                grasp(f"grasp the {arm} sleeve again"))}, attempts=3),
        RecoverBy(f"over the {arm} hand", PullAlongArm(f"pull over the {arm} hand", context, grip=grip, hold=hold,
                                                       upto=PAST_WRIST), {Reason.SLEEVE_MISSED: again}, attempts=3),
        fallback(f"free the lifting hand, {arm}",
                 ReleaseArm(f"let the {arm} arm go", context, hand=lifting, ready=True),
                 ReleaseArm(f"leave the {arm} arm", context, hand=lifting)),
        RecoverBy(f"up to the {arm} shoulder", PullAlongArm(
            f"pull up to the {arm} shoulder", context, grip=grip, upto=HEAD_END, seat=SEAT,
            stand=stance(arm, "shoulder"), taut=TAUT_ON[arm]),
            {Reason.ARM_LOST: lambda: look("look again at")}, attempts=2),
        SeatSleeve(f"seat the {arm} sleeve", context, grip=grip))
    recoveries = {reason: (lambda name=name: let_go(name)) for reason, name in (
        (Reason.SLEEVE_CAUGHT, "caught sleeve"), (Reason.CLOTH_SLIPPED, "slipped cloth"),
        (Reason.ARM_SLIPPED, "slipped arm"), (Reason.GRASP_MISSED, "missed grasp"), (Reason.ARM_LOST, "lost arm"),
        (Reason.NOTHING_SEEN, "nothing seen"), (Reason.UNREACHABLE, "out of reach"),
        (Reason.MOTION_BLOCKED, "blocked motion"), (Reason.FORCE_LIMIT, "too much force"),
        (Reason.SLEEVE_MISSED, "missed hand"), (Reason.SLEEVE_FOLDED, "folded sleeve"),
        (Reason.TIMEOUT, "slow lift"))}
    return sequence(f"dress the {arm} arm",
                    RecoverBy(f"lift and pull again, {arm}", lift_and_pull, recoveries, attempts=2),
                    back_off(context, f"back off from the {arm} arm", 0.25))


def back_off(context: Context, name: str, distance: float) -> Behaviour:
    """Let go, draw back by `distance` [m], arms ready; or as they are, where no way to the ready posture is found."""
    return fallback(name, Retreat(f"{name}, arms ready", context, back=distance),
                    Retreat(f"{name}, arms as they are", context, back=distance, ready=False))


def dress(context: Context) -> Behaviour:
    """Stage C."""
    go_round = Navigate("drive round the foot of the bed", context, goal="bed_left")
    return Stage("C dress", None, Timeout("C in time", sequence(
        "dress both arms", Retreat("bring the arms back", context, clear=0.05),
        Navigate("go to the right side", context, goal="bed_right"),
        dress_arm(context, "right"), go_round, dress_arm(context, "left")), seconds=400.0))


def spread(context: Context) -> Behaviour:
    """Stage D: what counts is a covered chest; where it is not, the collar is drawn on the left, then on the right."""
    order: tuple[tuple[Side, str], ...] = (("left", "bed_left"), ("right", "bed_right"))
    sides: list[Behaviour] = []
    for side, waypoint in order:
        draw = sequence(
            f"draw the collar to the {side} shoulder",
            Navigate(f"go to the {side} shoulder", context, goal=waypoint),
            Navigate(f"stand by the {side} shoulder", context, goal=stance(side, "shoulder")),
            LookAtPerson(f"look at the {side} shoulder", context, side=side, posture=Key(f"{side}_near")),
            Retry(f"spread again, {side}", Spread(f"spread to the {side} shoulder", context, side=side,
                                                  hand=PULLING[side], grasp=Key(f"{side}_collar")), attempts=2),
            Retreat(f"leave the {side} shoulder", context, back=0.3))
        as_it_is = Retreat(f"leave the {side} shoulder as it is", context, back=0.3)
        sides.append(fallback(f"the {side} shoulder, as far as it goes", draw, as_it_is))

    def covered(name: str) -> Behaviour:
        return Condition(name, _chest_covered, Reason.NOTHING_SEEN)

    return Stage("D spread", None, Timeout("D in time", fallback(
        "spread the gown", covered("it lies spread already"),
        sequence("draw it straight", *sides, covered("the chest is covered"))), seconds=200.0))


def make_safe(context: Context) -> Behaviour:
    """What is owed whenever a stage fails: lower a held arm, let go, back off, stop."""
    return sequence("make safe",
                    *(fallback(f"safe: {side} hand", ReleaseArm(f"safe: {side} hand lowers the arm", context, hand=side,
                                                                lower=True),
                               ReleaseArm(f"safe: {side} hand opens", context, hand=side)) for side in SIDES),
                    Retreat("safe: let go and back off", context, back=0.2, ready=False))


def _chest_covered(context: Context) -> bool:
    """The head camera sees gown on most of the trunk, which lies where the map's bed says."""
    bed = context.world.room.bed
    shoulders = np.array((*bed[:, :2].mean(axis=0), bed[1, 2])) + SHOULDERS_ON_BED
    cover = context.perceive("chest_cover", context.world.look("head"), shoulders_in_map=shoulders)
    assert isinstance(cover, Cover)
    return cover.share > COVERED
