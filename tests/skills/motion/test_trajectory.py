import numpy as np
import pytest
from caretree.sim.mechanics.collision import CollisionChecker
from caretree.sim.mechanics.kinematics import Kinematics
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import SIDES
from caretree.skills.motion.ik import hand_pose, solve_ik
from caretree.skills.motion.reach import plan_reach
from caretree.skills.motion.trajectory import free_postures, plan_joint_motion

BASE = np.array((0.95, -0.2, np.pi))
BED = np.array((((-0.45, -1.0, 0.35), (0.45, 1.0, 0.60)),))


@pytest.fixture(scope="module")
def kinematics():
    return Kinematics(BAXTER)


def rates(trajectory):
    step = np.diff(trajectory.times)
    velocity = np.diff(trajectory.positions, axis=0) / step[:, None]
    return np.abs(velocity).max(axis=0), np.abs(np.diff(velocity, axis=0) / step[1:, None]).max(axis=0)


def hand_path(kinematics, trajectory, side):
    n = trajectory.joints.index(f"{side}_s0")
    return np.array([kinematics.pose_hand_in_map(side, q[n : n + 7], BASE)[:3, 3] for q in trajectory.positions])


def hand_speed(kinematics, trajectory, side):
    path = hand_path(kinematics, trajectory, side)
    return np.linalg.norm(np.diff(path, axis=0), axis=1) / np.diff(trajectory.times)


def random_waypoints(kinematics, count, seed):
    generator = np.random.default_rng(seed)
    return {
        side: np.vstack(
            (
                model.READY[n],
                generator.uniform(0.6 * kinematics.limits[side].lower, 0.6 * kinematics.limits[side].upper, (count, 7)),
            )
        )
        for n, side in enumerate(SIDES)
    }


@pytest.mark.parametrize("scale", [1.0, 0.4])
def test_limits_are_kept_and_one_of_them_is_used(kinematics, scale):
    for seed in range(3):
        trajectory = plan_joint_motion(kinematics, random_waypoints(kinematics, 4, seed), speed_scale=scale)
        limits = [kinematics.limits[side] for side in SIDES]
        speed, acceleration = rates(trajectory)
        assert (speed <= 1.02 * scale * np.concatenate([limit.velocity for limit in limits])).all()
        share = acceleration / scale**2 / np.concatenate([limit.acceleration for limit in limits])
        assert (share <= 1.1).all()
        assert share.max() > 0.8
        assert trajectory.joints == model.ALL_ARM_JOINTS
        assert trajectory.times[0] == 0.0
        assert np.diff(trajectory.times).max() <= 0.0201


def test_it_passes_its_waypoints_and_rests_at_both_ends(kinematics):
    waypoints = {"left": random_waypoints(kinematics, 3, 9)["left"]}
    trajectory = plan_joint_motion(kinematics, waypoints)
    for point in waypoints["left"]:
        assert np.abs(trajectory.positions - point).max(axis=1).min() < 0.05
    np.testing.assert_allclose(trajectory.positions[[0, -1]], waypoints["left"][[0, -1]], atol=1e-6)
    ends = np.abs(np.diff(trajectory.positions, axis=0)[[0, -1]]) / 0.02
    assert ends.max() < 0.06


def test_the_hand_obeys_its_speed_limit_where_the_limit_holds(kinematics):
    waypoints = random_waypoints(kinematics, 2, 5)
    slow = plan_joint_motion(kinematics, waypoints, BASE, hand_speed=0.15)
    assert max(hand_speed(kinematics, slow, side).max() for side in SIDES) <= 0.15

    def near_the_head(positions):
        return np.where(positions[:, 0] < 0.45, 0.1, 10.0)

    goals = {"right": hand_pose((0.2, -0.1, 0.9), (-1, 0, -1))}
    trajectory = plan_reach(kinematics, goals, model.READY, BASE, free="approach", hand_speed=near_the_head)
    speed, path = hand_speed(kinematics, trajectory, "right"), hand_path(kinematics, trajectory, "right")
    assert speed[path[:-1, 0] < 0.44].max() <= 0.102
    free = plan_reach(kinematics, goals, model.READY, BASE, free="approach")
    assert trajectory.times[-1] > free.times[-1]


def test_being_there_already_is_a_motion_too(kinematics):
    trajectory = plan_joint_motion(kinematics, {"left": np.stack((model.READY[0], model.READY[0]))})
    np.testing.assert_allclose(trajectory.positions, np.stack((model.READY[0],) * 2))


def test_waypoints_that_do_not_fit_are_refused(kinematics):
    with pytest.raises(ValueError, match="same k"):
        plan_joint_motion(kinematics, {"left": np.zeros((2, 7)), "right": np.zeros((3, 7))})
    with pytest.raises(ValueError, match="speed_scale"):
        plan_joint_motion(kinematics, {"left": np.zeros((2, 7))}, speed_scale=2.0)


def test_an_arm_may_move_beside_another_that_touches_already(kinematics):
    """Velocity control brings a lifting arm's elbow within the margin of the head; the other arm has to go on."""
    base, checker = np.array((1.05, -0.38, np.pi)), CollisionChecker(kinematics, BED)
    lifted = hand_pose(np.array((0.37, -0.33, 0.93)), np.array((0.0, 0.0, -1.0)), np.array((0.6, 0.8, 0.0)))
    arms = model.READY.copy()
    arms[0] = solve_ik(kinematics, "left", lifted, base, arms[0])
    assert checker.collisions(base, arms), "the posture touches"
    free = free_postures(checker, "right", base, arms)
    assert free(arms[1])
    inside = hand_pose(np.array((0.30, 0.05, 0.45)), np.array((0.0, 0.0, -1.0)))
    assert not free(solve_ik(kinematics, "right", inside, base, arms[1], free="approach")), "the bed is in the way"
