import numpy as np
import pytest
from caretree.sim.mechanics.collision import CollisionChecker
from caretree.sim.mechanics.kinematics import Kinematics
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import SIDES
from caretree.skills.motion.errors import MotionBlocked, Unreachable
from caretree.skills.motion.ik import hand_pose
from caretree.skills.motion.reach import ReachTuning, plan_arms, plan_hand_line, plan_reach, plan_straight_reach

BASE = np.array((0.95, -0.2, np.pi))
BED = np.array((((-0.45, -1.0, 0.35), (0.45, 1.0, 0.60)),))


@pytest.fixture(scope="module")
def kinematics():
    return Kinematics(BAXTER)


def hand_path(kinematics, trajectory, side):
    n = trajectory.joints.index(f"{side}_s0")
    return np.array([kinematics.pose_hand_in_map(side, q[n : n + 7], BASE)[:3, 3] for q in trajectory.positions])


def before_a_board(kinematics, before, beyond):
    """A checker with a board, both arms, the left hand `before` it along y [m], and a pose `beyond` it."""
    checker = CollisionChecker(kinematics, np.array((((-0.1, -0.52, 0.6), (0.42, -0.48, 1.0)),)))
    arms = model.READY.copy()
    start, goal = (hand_pose((0.25, y, 0.85), (-1, 0, -1)) for y in (before, beyond))
    arms[0] = plan_reach(kinematics, {"left": start}, arms, BASE, free="approach", checker=checker).positions[-1]
    return checker, arms, goal


def test_a_line_is_straight_and_keeps_both_hands_together(kinematics):
    goals = {}
    for n, side in enumerate(SIDES):
        pose = kinematics.pose_hand_in_map(side, model.READY[n], BASE)
        pose[:3, 3] += (-0.15, 0.05, 0.2)
        goals[side] = pose
    trajectory = plan_hand_line(kinematics, goals, model.READY, BASE, hand_speed=0.2)
    for side in SIDES:
        path = hand_path(kinematics, trajectory, side)
        along = (path[-1] - path[0]) / np.linalg.norm(path[-1] - path[0])
        off = (path - path[0]) - np.outer((path - path[0]) @ along, along)
        assert np.abs(off).max() < 1e-3
        np.testing.assert_allclose(path[-1], goals[side][:3, 3], atol=1e-3)
    apart = hand_path(kinematics, trajectory, "left") - hand_path(kinematics, trajectory, "right")
    assert np.ptp(apart, axis=0).max() < 1e-3


def off_the_line(path):
    along = (path[-1] - path[0]) / np.linalg.norm(path[-1] - path[0])
    off = (path - path[0]) - np.outer((path - path[0]) @ along, along)
    return np.linalg.norm(off, axis=1).max()


@pytest.mark.parametrize(
    ("position", "approach", "closing"),
    [
        ((0.54, -0.65, 1.13), (-0.7, -1.3, 1.4), (0.5, -0.4, -0.2)),
        ((0.28, -0.70, 0.87), (-1.0, 0.1, -0.6), (-0.8, 0.8, 0.4)),
        ((0.47, -0.74, 0.83), (-1.9, -0.6, -0.7), (-0.7, -1.4, 0.8)),
    ],
)
def test_where_an_even_turn_does_not_get_the_hand_still_goes_straight(kinematics, position, approach, closing):
    goal = hand_pose(position, approach, closing)
    with pytest.raises(Unreachable):
        plan_hand_line(kinematics, {"left": goal}, model.READY, BASE)
    aside = hand_path(kinematics, plan_reach(kinematics, {"left": goal}, model.READY, BASE), "left")
    assert off_the_line(aside) > 0.1
    trajectory = plan_straight_reach(kinematics, {"left": goal}, model.READY, BASE, hand_speed=0.2)
    straight = hand_path(kinematics, trajectory, "left")
    assert off_the_line(straight) < 2e-3
    end = kinematics.pose_hand_in_map("left", trajectory.positions[-1], BASE)
    np.testing.assert_allclose(end, goal, atol=6e-3)


def test_a_straight_way_through_the_bed_is_refused(kinematics):
    arms = model.READY.copy()
    start, goal = (hand_pose((x, -0.3, 0.72), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)) for x in (0.6, 0.0))
    high = np.array((((0.2, -1.0, 0.35), (0.4, 1.0, 0.80)),))  # a board between the two
    arms[0] = plan_reach(kinematics, {"left": start}, arms, BASE).positions[-1]
    with pytest.raises(MotionBlocked, match="box 0"):
        plan_straight_reach(kinematics, {"left": goal}, arms, BASE, checker=CollisionChecker(kinematics, high))


def test_a_line_out_of_reach_or_through_the_bed_is_refused(kinematics):
    pose = kinematics.pose_hand_in_map("left", model.READY[0], BASE)
    pose[:3, 3] += (-1.2, 0.0, 0.0)
    with pytest.raises(Unreachable):
        plan_hand_line(kinematics, {"left": pose}, model.READY, BASE)
    low = kinematics.pose_hand_in_map("left", model.READY[0], BASE)
    low[:3, 3] += (-0.1, 0.0, -0.45)
    with pytest.raises(MotionBlocked, match="box 0"):
        plan_hand_line(
            kinematics, {"left": low}, model.READY, BASE, free="approach", checker=CollisionChecker(kinematics, BED)
        )


def test_reaching_goes_round_what_is_in_the_way(kinematics):
    checker, arms, beyond = before_a_board(kinematics, -0.75, -0.28)
    straight = plan_reach(kinematics, {"left": beyond}, arms, BASE, free="approach")
    assert not all(checker.free(BASE, np.stack((q, arms[1]))) for q in straight.positions)
    round_it = plan_reach(kinematics, {"left": beyond}, arms, BASE, free="approach", checker=checker)
    assert not any(checker.collisions(BASE, np.stack((q, arms[1]))) for q in round_it.positions[::3])
    hand = kinematics.pose_hand_in_map("left", round_it.positions[-1], BASE)
    np.testing.assert_allclose(hand[:3, 3], beyond[:3, 3], atol=1e-3)
    again = plan_reach(kinematics, {"left": beyond}, arms, BASE, free="approach", checker=checker)
    np.testing.assert_array_equal(again.positions, round_it.positions)


def test_of_ways_round_it_that_take_long_the_quickest_is_gone(kinematics):
    checker, arms, beyond = before_a_board(kinematics, -0.70, -0.30)

    def taken(speed, ways):
        """How long the way takes [s]."""
        return plan_reach(
            kinematics,
            {"left": beyond},
            arms,
            BASE,
            free="approach",
            hand_speed=speed,
            checker=checker,
            tuning=ReachTuning(ways=ways),
        ).times[-1]

    slow = [taken(0.05, ways) for ways in (1, 2, 3, 4)]
    assert slow[0] > ReachTuning().long_way
    assert slow == sorted(slow, reverse=True)
    assert slow[-1] < 0.9 * slow[0]
    assert taken(1.0, 1) == taken(1.0, 4), "a quick one is gone at once"


def test_an_arm_moves_while_the_other_one_touches_something(kinematics):
    hand = kinematics.pose_hand_in_map("left", model.READY[0], BASE)[:3, 3]
    at_the_other = CollisionChecker(kinematics, np.array(((hand - 0.05, hand + 0.05),)))
    assert not at_the_other.free(BASE, model.READY)
    motion = plan_arms(kinematics, 0.9 * model.READY, model.READY, BASE, sides=("right",), checker=at_the_other)
    np.testing.assert_allclose(motion.positions[-1], 0.9 * model.READY[1], atol=1e-6)


def test_both_arms_that_velocity_control_brought_to_the_head_come_away_from_it(kinematics):
    """Drawn up with every sleeve that was let go of, both elbows came to the head, and nothing moved any more."""
    base = np.array((-0.974, -0.607, 0.0))
    up = np.array(
        ((1.702, -2.147, -2.769, 1.934, -0.72, 0.348, -1.957), (0.563, -1.723, 0.617, 1.149, 0.119, 2.094, 1.371))
    )
    checker = CollisionChecker(kinematics, BED)
    touching = {("left_lower_elbow", "head"), ("right_lower_elbow", "head")}
    assert touching.issubset(checker.collisions(base, up))
    begins = checker.contacts(base, up)
    motion = plan_arms(kinematics, model.READY, up, base, checker=checker)
    postures = motion.positions.reshape(len(motion.positions), 2, 7)
    np.testing.assert_allclose(postures[-1], model.READY, atol=1e-6)
    assert checker.free(base, postures[-1])
    for arms in postures:
        gaps = checker.contacts(base, arms)
        assert all(gap > begins.get(pair, 0.01) - 0.003 for pair, gap in gaps.items()), "nearer than where it began"


def test_a_goal_in_a_box_is_told(kinematics):
    hand = kinematics.pose_hand_in_map("left", model.READY[0], BASE)[:3, 3]
    inside = CollisionChecker(kinematics, np.array(((hand - 0.3, hand + 0.3),)))
    with pytest.raises(MotionBlocked, match="goal"):
        plan_arms(kinematics, 0.9 * model.READY, model.READY, BASE, checker=inside)
