"""An arm is let go where it lies and nowhere else; a hand that holds none opens at once."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.person.arm_fit import turned_about_shoulder
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.robot.model import READY
from caretree.sim.world import GripperOpening, HandTwist, JointTrajectory, SensorLost
from caretree.skills.belief.person_tracking import Watch
from caretree.skills.control.arm_grip import over_arm
from caretree.skills.control.lowering import LoweringTuning
from caretree.skills.core.reasons import Reason
from caretree.skills.release_arm import ReleaseArm, ReleaseArmTuning
from caretree.skills.scripted.scripted_person import lying_posture

from .bench import ARM, CLOTH, LeafBench, above_arm, beside_bed, goes_along, pulls

LIES = lying_posture("right")
SHOULDER, ELBOW = LIES.points_in_map[:2]
UNSEEN = PerceptionFailure(Problem.NOTHING_SEEN, "person")
MATTRESS = 0.60  # [m] above the floor


def raised(coordinate=1.0, height=0.20):
    """The right arm turned about its shoulder until that place of it is so much higher [m]."""
    there = LIES.points_in_map[1] + (0.0, 0.0, height)
    return replace(LIES, points_in_map=turned_about_shoulder(LIES.points_in_map, coordinate, there))


def bench(
    *, posture=None, known=True, load=lambda height: (0.0, 0.0, -6.0), holds=ARM, slips_at=None, cloth=None, **options
):
    """The left hand round the elbow of a raised arm, which pulls with `load` of the hand's height over the mattress.

    The arm is known to the run, or neither known nor seen.  It slips out of the fingers at a tick, if one is given; the
    right hand holds cloth that pulls with `cloth`, if that is given; `options` are those of the leaf, or `deaf_to`, or
    whether it is `known_to_hold` that cloth.
    """
    posture = posture or raised()
    deaf_to, known_to_hold = options.pop("deaf_to", ()), options.pop("known_to_hold", False)

    def feels(bench):
        if len(bench.seen) == slips_at:
            bench.world.between_fingers["left"] = 0.0
        height = bench.world.observe().pose_hand_in_map[0, 2, 3] - MATTRESS
        held = bench.world.observe().gripper_opening[0] < ARM + 0.002
        pulls(bench.world, "left", load(height) if held else np.zeros(3))
        if cloth is not None:
            pulls(bench.world, "right", cloth)

    def leaf(context):
        if known:
            context.memory.of(Watch, Watch).arms["right"] = posture
        if known_to_hold:
            context.guard.declare_grip("right", "cloth")
        return ReleaseArm("release", context, hand="left", **options)

    sight, blind = {"arm": goes_along(posture)}, dict.fromkeys(("arm", "head"), UNSEEN)
    hands, held = {"left": over_arm(posture, 1.0, 0.0)}, {"left": holds}
    if cloth is not None:
        hands["right"], held["right"] = above_arm(1.6, 0.25), CLOTH
    run = LeafBench(
        leaf, beside_bed(hands=hands, held=held, deaf_to=deaf_to, **(sight if known else blind)), each_tick=feels
    )
    run.context.guard.declare_grip("left", "arm")
    return run


def parted(run):
    """Number of ticks until the fingers part."""
    return int(np.argmax(run.openings("left") > run.openings("left")[0] + 0.002))


@pytest.mark.parametrize(("aside_first", "friction", "spread"), [(3.0, 12.0, 0.67), (0.0, 0.0, 0.59)])
def test_an_arm_that_is_to_be_spread_is_although_its_joint_resists(aside_first, friction, spread):
    lowering = LoweringTuning(spread=0.9, friction=friction, aside_first=aside_first)
    tuning = ReleaseArmTuning(lowering=lowering)
    turn = np.array(((np.cos(0.4), -np.sin(0.4), 0.0), (np.sin(0.4), np.cos(0.4), 0.0), (0.0, 0.0, 1.0)))  # 0.4 rad
    beside = replace(raised(), points_in_map=SHOULDER + (raised().points_in_map - SHOULDER) @ turn.T)
    run = bench(lower=True, tuning=tuning, posture=beside, load=lambda height: (-9.0, 0.0, -6.0))  # [N], inwards
    assert run.ended() is None
    way = run.way("left") - SHOULDER
    aside = np.arctan2(way[:, 0], way[:, 1])[: parted(run)]  # [rad]
    assert aside[0] == pytest.approx(0.42, abs=0.02)
    assert aside[-1] == pytest.approx(spread, abs=0.03)


def test_an_arm_is_swung_down_about_its_shoulder_until_it_lies_and_let_go_there():
    run = bench(lower=True)
    assert run.ended() is None
    way, opens = run.way("left"), parted(run)
    assert way[opens, 2] == pytest.approx(ELBOW[2], abs=0.03)
    assert np.linalg.norm(way[:opens] - SHOULDER, axis=1) == pytest.approx(np.linalg.norm(way[0] - SHOULDER), abs=0.01)
    assert np.linalg.norm(np.diff(way[:opens], axis=0), axis=1).max() < 0.05 / 15  # [m] a tick
    assert run.openings("left")[-1] > 0.08, "the hand is open"
    assert way[-1, 2] - way[opens, 2] == pytest.approx(0.16, abs=0.03), "it is clear of the arm"


def test_where_it_lies_in_the_end_is_told_to_what_follows_the_arm():
    run = bench(lower=True)
    assert run.ended() is None
    told = run.context.memory.of(Watch, Watch)
    assert told.arms["right"].points_in_map[1] == pytest.approx(run.way("left")[parted(run)], abs=0.02)
    assert told.seen["right"] > 3.0  # [s]: on the way too little of it showed


@pytest.mark.parametrize("weight", [0.0, 2.0, -8.0, 15.0])
def test_no_load_is_taken_for_the_bed_as_long_as_the_hand_comes_down(weight):
    run = bench(lower=True, load=lambda height: (0.0, 0.0, -weight))
    assert run.ended() is None
    assert run.way("left")[parted(run), 2] < ELBOW[2] + 0.04


def test_an_arm_whose_forearm_stays_up_is_lowered_until_the_hand_is_at_the_mattress():
    points = raised().points_in_map.copy()
    points[2:] = points[1] + np.outer((0.25, 0.42), (0.0, 0.3, 0.95))
    run = bench(lower=True, posture=replace(LIES, points_in_map=points))
    assert run.ended() is None
    assert run.way("left")[parted(run), 2] == pytest.approx(MATTRESS + 0.04, abs=0.01)


def test_an_arm_of_which_nothing_is_known_any_more_is_lowered_straight_down():
    run = bench(lower=True, known=False)
    assert run.ended() is None
    way, opens = run.way("left"), parted(run)
    assert way[opens, 2] == pytest.approx(MATTRESS + 0.04, abs=0.01)
    assert np.ptp(way[:opens, :2], axis=0).max() < 0.01


def test_without_a_picture_the_hand_goes_down_to_the_mattress():
    run = bench(lower=True)

    def dead(camera):
        raise SensorLost("the camera is dead")

    run.world.look = dead
    assert run.ended() is None
    assert run.way("left")[parted(run), 2] == pytest.approx(MATTRESS + 0.04, abs=0.01)


@pytest.mark.parametrize(("stops_at", "reason"), [(0.12, None), (0.20, Reason.MOTION_BLOCKED)])
def test_the_bed_carries_an_arm_that_pushes_back_near_the_mattress_only(stops_at, reason):
    run = bench(lower=True, load=lambda height: (0.0, 0.0, 16.5 if height < stops_at else -2.0))
    assert run.ended() is reason
    lowest = run.way("left")[:, 2].min() - MATTRESS
    assert lowest == pytest.approx(stops_at, abs=0.015)
    held = bool(abs(run.openings("left")[-1] - ARM) < 0.003)
    assert held is (reason is not None), "an arm that does not lie is still held"


def test_a_hand_that_stands_without_being_pushed_is_no_arm_that_lies():
    run = bench(lower=True)
    run.world.deaf_to = (HandTwist,)
    assert run.ended() == Reason.MOTION_BLOCKED
    assert run.openings("left")[-1] == pytest.approx(ARM, abs=0.003)


def test_it_gives_way_to_what_pulls_aside():
    straight, aside = bench(lower=True), bench(lower=True, load=lambda height: (-14.0, 0.0, -2.0))
    assert straight.ended() is None
    assert aside.ended() is None
    given = aside.way("left")[parted(aside)] - straight.way("left")[parted(straight)]
    assert given[0] < -0.03  # [m] towards the body
    assert aside.way("left")[parted(aside), 2] < ELBOW[2] + 0.04


@pytest.mark.parametrize(("pull", "sinks"), [(4.5, True), (1.5, False)])
def test_a_sleeve_over_the_arm_comes_along_as_soon_as_it_pulls(pull, sinks):
    run = bench(lower=True, cloth=(0.0, 0.0, -pull))
    assert run.ended() is None
    sunk = run.way("right")[0, 2] - run.way("right")[parted(run), 2]
    assert bool(sunk > 0.05) is sinks
    assert run.openings("right").max() < 0.01, "it is still held"


def test_a_hand_that_is_known_to_hold_a_sleeve_goes_down_with_the_arm():
    run = bench(lower=True, cloth=(0.0, 0.0, -1.5), known_to_hold=True)
    assert run.ended() is None
    down, along = (run.way(side)[parted(run)] - run.way(side)[0] for side in ("left", "right"))
    assert down[2] < -0.1  # [m]
    assert along == pytest.approx(down, abs=0.03)  # [m]
    assert run.openings("right").max() < 0.01, "it is still held"


@pytest.mark.parametrize(("holds", "lower"), [(ARM, False), (0.0, True)], ids=("not asked to lower", "holds nothing"))
def test_it_opens_at_once_where_nothing_is_to_be_lowered(holds, lower):
    run = bench(lower=lower, holds=holds)
    start = run.world.observe().pose_hand_in_map[0, 2, 3]
    assert run.ended() is None
    assert parted(run) <= 2
    assert run.way("left")[:, 2].min() == pytest.approx(start, abs=0.002)
    assert run.openings("left")[-1] > 0.08


def test_an_open_hand_is_not_lowered():
    run = bench(lower=True)
    run.world.between_fingers["left"] = 0.0
    run.world.send(GripperOpening(side="left", opening=0.085))
    run.let_pass(1.0)
    start = run.world.observe().pose_hand_in_map[0, 2, 3]
    assert run.ended() is None
    assert run.way("left")[:, 2].min() > start - 0.002


def test_one_that_is_to_be_ready_ends_in_the_ready_posture():
    run = bench(ready="always")
    assert run.ended() is None
    ready = kinematics_of(BAXTER).pose_hand_in_map("left", READY[0], run.world.observe().pose_base_in_map)
    assert run.way("left")[-1] == pytest.approx(ready[:3, 3], abs=0.03)
    stays = bench(ready="never")
    assert stays.ended() is None
    assert np.linalg.norm(stays.way("left")[-1] - ready[:3, 3]) > 0.1


@pytest.mark.parametrize(("ready", "reason"), [("always", Reason.COMMAND_LOST), ("if possible", None)])
def test_a_hand_that_does_not_get_ready_is_a_failure_only_where_it_has_to(ready, reason):
    run = bench(ready=ready, deaf_to=(JointTrajectory,))
    assert run.ended() == reason
    assert run.openings("left")[-1] > 0.08


def test_fingers_that_do_not_open_are_told():
    assert bench(deaf_to=(GripperOpening,)).ended() == Reason.COMMAND_LOST


def test_an_arm_that_slips_out_on_the_way_down_is_lowered_no_farther():
    run = bench(lower=True, slips_at=30)
    assert run.ended() is None
    way = run.way("left")[:, 2]
    assert 0.04 < way[0] - way.min() < 0.12  # [m]: 2 s at 0.045 m/s, and the time until the fingers have closed
