"""From wherever it is, the robot lets go, draws back the way its hands point, and leaves the person alone."""

import numpy as np
import pytest
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.robot.model import READY
from caretree.sim.world import SIDES, BaseVelocity, GripperOpening, JointTrajectory
from caretree.skills.control.withdraw import WithdrawTuning
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import HEADWARD, outwards
from caretree.skills.motion.ik import hand_pose
from caretree.skills.retreat import Retreat, RetreatTuning

from .bench import ARM, CLOTH, LeafBench, beside_bed, on_arm

STAND = (1.05, -0.38, np.pi)  # beside the right arm, facing the bed [m, m, rad]
TILT = 0.4  # [rad] of a hand that comes from above and from the robot's side
POINTS = np.array((-np.sin(TILT), 0.0, -np.cos(TILT)))  # down and towards the person


def bench(*, deaf_to=(), right=CLOTH, **options):
    """The left hand holds the arm, the right one a sleeve beyond the fingertips, or what keeps them `right` apart."""
    hands = {"left": on_arm(1.0, 0.15), "right": hand_pose(np.array((0.40, -0.20, 0.85)), POINTS, HEADWARD)}
    return LeafBench(
        lambda context: Retreat("retreat", context, **options),
        beside_bed(stand=STAND, hands=hands, held={"left": ARM, "right": right}, deaf_to=deaf_to),
    )


def begun(values, by):
    """First tick at which a quantity (n,) has changed by so much."""
    return int(np.argmax(np.abs(values - values[0]) > by))


def test_the_fingers_open_before_a_hand_draws_back_and_the_base_leaves_last():
    run = bench(base_distance=0.4, ready="never")
    assert run.ended() is None
    base = np.array([seen.pose_base_in_map for seen in run.seen])
    for side, enough in (("left", 0.08), ("right", 0.03)):  # an arm, cloth
        opened, leaves = int(np.argmax(run.openings(side) > enough)), begun(run.way(side)[:, 2], 0.005)
        assert 0 < opened < leaves < begun(base[:, 0], 0.005)
    assert run.openings("right")[:leaves].max() < 0.04, "no wider beside the person than cloth needs"
    assert min(run.openings(side)[-1] for side in SIDES) > 0.08
    assert base[-1] == pytest.approx((1.45, -0.38, np.pi), abs=0.02)  # 0.4 m back, still facing the bed


def test_fingers_that_are_open_do_not_open_farther_beside_the_person():
    """They had come down to a leg, and pushed it as they opened (147)."""
    run = bench(right=0.05, ready="never")  # as far as they are on their way to cloth
    assert run.ended() is None
    openings, leaves = run.openings("right"), begun(run.way("right")[:, 2], 0.05)
    assert openings[:leaves] == pytest.approx(0.05, abs=0.005)
    assert openings[-1] > 0.08


def test_each_hand_draws_back_the_way_it_points():
    run = bench(hand_distance=0.12, ready="never")
    assert run.ended() is None
    moved = {side: run.way(side)[-1] - run.start.pose_hand_in_map[n, :3, 3] for n, side in enumerate(SIDES)}
    assert moved["left"] == pytest.approx((0.0, 0.0, 0.12), abs=0.02)
    assert moved["right"] == pytest.approx(-0.12 * POINTS, abs=0.02)
    turned = run.poses("right")[-1, :3, :3].T @ run.start.pose_hand_in_map[1, :3, :3]
    assert turned == pytest.approx(np.eye(3), abs=0.05)


@pytest.mark.parametrize(("min_rise", "moved"), [(0.3, (0.0, 0.0, 0.12)), (-1.0, (0.12, 0.0, 0.0))])
def test_a_hand_that_lies_flat_goes_straight_up_unless_it_may_go_back_the_way_it_points(min_rise, moved):
    level = {"right": hand_pose(np.array((0.25, -0.30, 1.0)), -outwards("right"), HEADWARD)}
    tuning = RetreatTuning(withdraw=WithdrawTuning(min_rise=min_rise))
    run = LeafBench(
        lambda context: Retreat("retreat", context, hands="right", hand_distance=0.12, ready="never", tuning=tuning),
        beside_bed(stand=STAND, hands=level, held={"right": CLOTH}),
    )
    assert run.ended() is None
    assert run.way("right")[-1] - run.start.pose_hand_in_map[1, :3, 3] == pytest.approx(moved, abs=0.02)


def test_the_arms_are_ready_in_the_end_and_the_base_stays_if_it_may():
    run = bench()
    assert run.ended() is None
    last = run.seen[-1]
    ready = [kinematics_of(BAXTER).pose_hand_in_map(side, READY[n], STAND) for n, side in enumerate(SIDES)]
    assert last.pose_hand_in_map[:, :3, 3] == pytest.approx(np.array(ready)[:, :3, 3], abs=0.03)
    assert last.pose_base_in_map == pytest.approx(STAND, abs=0.005)


@pytest.mark.parametrize(("ready", "reason"), [("always", Reason.COMMAND_LOST), ("if possible", None)])
def test_arms_that_do_not_get_ready_are_a_failure_only_where_they_have_to(ready, reason):
    run = bench(ready=ready, deaf_to=(JointTrajectory,))
    assert run.ended() == reason
    assert min(run.openings(side)[-1] for side in SIDES) > 0.08
    assert min(run.way(side)[-1, 2] - run.way(side)[0, 2] for side in SIDES) > 0.1, "both hands are clear of the person"


def test_the_other_hand_keeps_what_it_holds():
    run = bench(hands="left")
    assert run.ended() is None
    assert run.openings("left")[-1] > 0.08
    assert run.openings("right").max() < 0.01
    assert run.way("right")[-1] == pytest.approx(run.start.pose_hand_in_map[1, :3, 3], abs=0.005)


@pytest.mark.parametrize(("deaf_to", "moves"), [(GripperOpening, False), (BaseVelocity, True)])
def test_a_command_that_is_lost_is_told(deaf_to, moves):
    run = bench(deaf_to=(deaf_to,), base_distance=0.4)
    assert run.ended() == Reason.COMMAND_LOST
    assert bool(np.ptp(run.way("left")[:, 2]) > 0.05) == moves, "no hand draws back before it is open"


@pytest.mark.parametrize(("load", "before"), [(15.0, 0.02), (8.0, 0.0)])
def test_a_hand_that_rests_on_the_person_goes_back_before_its_fingers_open(load, before):
    """Of one that stood on a shoulder with 21 N they pressed the trunk with 88 N (193)."""
    hands = {"right": hand_pose(np.array((0.40, -0.20, 0.85)), POINTS, HEADWARD)}
    room = beside_bed(stand=STAND, hands=hands, held={"right": CLOTH}, load={"right": (0.0, 0.0, load)})
    run = LeafBench(lambda context: Retreat("retreat", context, hands="right", ready="never"), room)
    assert run.ended() is None
    opened = int(np.argmax(run.openings("right") > 0.02))
    way = (run.way("right")[opened] - run.start.pose_hand_in_map[1, :3, 3]) @ -POINTS
    assert way == pytest.approx(before, abs=0.012)
