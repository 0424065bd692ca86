"""The dressing tree: stages A to D, each with its precondition, retries and recoveries, under one fail-safe.

A  take the gown down: go to the side of the rail that shows the outside, take both ends of the neckline, lift it off
B  unfold it and lay it on the person, outside up, arms bare
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
from ..skills.flip_side_check import FlipSideCheck
from ..skills.grasp_sleeve import GraspSleeve
from ..skills.lay_gown import LayGown
from ..skills.lift_arm import LiftArm
from ..skills.look_at_person import LookAtPerson
from ..skills.navigate import Navigate
from ..skills.ports import Key
from ..skills.pre_grasp_manipulate import PreGraspManipulate
from ..skills.present_sleeve import PresentSleeve
from ..skills.pull_along_arm import PullAlongArm
from ..skills.raise_corner import RaiseCorner
from ..skills.reasons import Reason
from ..skills.release import Release
from ..skills.release_arm import ReleaseArm
from ..skills.retreat import Retreat
from ..skills.segment_and_grasp import SegmentAndGrasp
from ..skills.spread import Spread
from ..skills.stretch_neckline import StretchNeckline
from ..skills.take_corner import TakeCorner
from ..skills.take_down import TakeDown
from ..skills.unhook import Unhook
from ..skills.view_around import ViewAround
from .composers import fallback, sequence
from .decorators import Condition, RecoverBy, Retry, Stage, Timeout

# Where a pull ends, beyond the shoulder [share of the upper arm]: the grip at the latest, the armhole where it is seen.
# The first sleeve slips back a little while the second is pulled.
HEAD_END: dict[Side, float] = {"right": -0.22, "left": -0.24}
SEAT: dict[Side, float] = {"right": -0.08, "left": -0.06}
# How hard a sleeve is drawn on its way to the hand; the second must not draw the first off its arm [N].
TAUT: dict[Side, float] = {"right": 4.0, "left": 1.8}
SHOULDERS_ON_BED = np.array((0.0, -0.55, 0.10))  # of an adult, from the middle of the mattress [m]
COVERED = 0.75  # share of the trunk under cloth that counts as covered, as far as a camera can tell
HAND_OF: dict[Side, Side] = {"left": "right", "right": "left"}  # the outside faces the robot: corners are mirrored
NECKLINE = 0.80  # both strips of a hung gown's neckline together, within 4 cm [m]
FARTHER_ROUND = float(np.deg2rad(75.0))  # behind the rail, where the fold that hides a corner opens to the robot [rad]
PAST_WRIST = 1.5  # where the lifting hand may let go: the grip is half way up the forearm


def take_down(context: Context) -> Behaviour:
    """Stage A."""
    find_outside = fallback(
        "find the outside",
        FlipSideCheck("outside to the front", context, hung=True, sure=0.0),
        Navigate("go behind the rail", context, goal="rail_back"))
    by_both_ends = sequence(
        "by both ends of the neckline",
        fallback("take both ends of the neckline", take_ends(context, "left"),
                 sequence("the other one first", Retreat("let go of both ends", context), take_ends(context, "right"))),
        TakeDown("lift it off the hook", context, hook=Key("hook")))
    return Stage("A take down", None, Timeout("A in time", sequence(
        "take the gown down", Navigate("go to the rail", context, goal="rail"), find_outside,
        fallback("take it", by_both_ends, from_one_hand(context))), seconds=260.0))


def from_one_hand(context: Context) -> Behaviour:
    """Where the ends do not show on the hook: off it with one hand, turned before the camera, corner by corner."""
    views, holder, former = Key("views"), Key("holder"), Key("former")
    return sequence(
        "from one hand",
        Retreat("let go of the neckline", context),
        SegmentAndGrasp("take it near the hook", context, side="right"),
        Unhook("lift it off with one hand", context, side="right"),
        ViewAround("look at it from all sides", context, side="right", views=views),
        PreGraspManipulate("take one corner", context, views=views, holder=holder, former=former),
        Release("let the place near the hook go", context, side=former),
        ViewAround("look at it again from all sides", context, side=holder, views=views),
        PreGraspManipulate("take the other corner", context, views=views, nearest=0.3))


def take_ends(context: Context, first: Side) -> Behaviour:
    """Both ends of the hung gown's neckline: `first`, the other one, the first again where that was not it."""
    second: Side = "right" if first == "left" else "left"
    hook, lengths, held = Key("hook"), {side: Key(f"{side}_strip") for side in SIDES}, Key("held")

    def take(corner: Side, name: str, **ports: object) -> TakeCorner:
        return TakeCorner(f"take the {corner} corner {name}", context, hand=HAND_OF[corner], sleeve=corner,
                          length=lengths[corner], **ports)

    def complete(context: Context) -> bool:
        """Both strips together are as long as a neckline."""
        return abs(sum(context.board.get(key.name) for key in lengths.values()) - NECKLINE) < 0.06

    again = sequence(
        f"the {first} corner was not it",
        Retreat(f"let the {first} one go", context, hands=HAND_OF[first]),
        RaiseCorner(f"draw the {second} corner aside for the {first}", context, hand=HAND_OF[second], hook=hook,
                    held=held),
        take(first, "once more", known_hook=hook, held=held))
    return sequence(
        f"take the ends, {first} first",
        Retry(f"the {first} corner, again", take(first, "first", hook=hook, opening=0.04, depth=0.006), attempts=2),
        RaiseCorner(f"draw the {first} corner aside first", context, hand=HAND_OF[first], hook=hook, held=held),
        FlipSideCheck(f"outside still to the front, {first} corner aside", context, sure=0.3),
        fallback(f"the {second} corner",
                 take(second, "second", known_hook=hook, held=held, opening=0.035),
                 take(second, "with wide fingers", known_hook=hook, held=held),
                 sequence(f"the {second} corner from farther round",
                          RaiseCorner(f"turn the gown by the {first} corner", context, hand=HAND_OF[first], hook=hook,
                                      away=FARTHER_ROUND),
                          take(second, "from farther round", known_hook=hook, held=held))),
        fallback(f"is it the neckline, {first} first", Condition(
            f"both ends, {first} first", complete, Reason.GRASP_MISSED), again))


def unfold(context: Context) -> Behaviour:
    """Stage B."""
    width = Key("neckline_width")
    return Stage("B unfold", _holds_gown, Timeout("B in time", sequence(
        "unfold and lay", StretchNeckline("stretch the neckline", context, width=width),
        FlipSideCheck("outside to the robot", context, sure=0.9),
        LayGown("lay it on the person", context, width=width)), seconds=120.0))


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

    def again() -> Behaviour:
        return PresentSleeve(f"bring the {arm} sleeve before the hand again", context, grip=grip, hold=hold,
                             taut=TAUT[arm])

    lift_and_pull = sequence(
        f"lift and pull, {arm}",
        Navigate(f"stand by the {arm} arm", context, goal=stance(arm, "lift")),
        look("look at"),
        LiftArm(f"lift the {arm} arm", context, side=arm, hand=lifting, hold=hold),
        GraspSleeve(f"grasp the {arm} sleeve", context, side=arm, hand=pulling, hold=hold, grip=grip),
        PresentSleeve(f"bring the {arm} sleeve before the hand", context, grip=grip, hold=hold,
                      taut=TAUT[arm]),
        RecoverBy(f"over the {arm} hand", PullAlongArm(f"pull over the {arm} hand", context, grip=grip, hold=hold,
                                                       upto=PAST_WRIST), {Reason.SLEEVE_MISSED: again}, attempts=3),
        fallback(f"free the lifting hand, {arm}",
                 ReleaseArm(f"let the {arm} arm go", context, hand=lifting, ready=True),
                 ReleaseArm(f"leave the {arm} arm", context, hand=lifting)),
        PullAlongArm(f"pull up to the {arm} shoulder", context, grip=grip, upto=HEAD_END[arm], seat=SEAT[arm],
                     stand=stance(arm, "shoulder")))
    recoveries = {reason: (lambda name=name: let_go(name)) for reason, name in (
        (Reason.SLEEVE_CAUGHT, "caught sleeve"), (Reason.CLOTH_SLIPPED, "slipped cloth"),
        (Reason.ARM_SLIPPED, "slipped arm"), (Reason.GRASP_MISSED, "missed grasp"), (Reason.ARM_LOST, "lost arm"),
        (Reason.NOTHING_SEEN, "nothing seen"), (Reason.UNREACHABLE, "out of reach"),
        (Reason.MOTION_BLOCKED, "blocked motion"), (Reason.FORCE_LIMIT, "too much force"),
        (Reason.SLEEVE_MISSED, "missed hand"),
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
    """Stage D: on the left, where the robot stands, then on the right; what counts in the end is a covered chest."""
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
    covered = Condition("the chest is covered", _chest_covered, Reason.NOTHING_SEEN)
    return Stage("D spread", None, Timeout("D in time", sequence("spread the gown", *sides, covered), seconds=200.0))


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


def _holds_gown(context: Context) -> bool:
    """Both hands together carry what a gown weighs [N]."""
    return bool(-np.sum(context.world.observe().wrench_hand_in_map[:, 2]) > 2.5)
