import numpy as np
import pytest
from caretree.sim.mechanics.kinematics import Kinematics
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import SIDES
from caretree.skills.motion.errors import Unreachable
from caretree.skills.motion.ik import half_turned, hand_pose, solve_ik

BASE = np.array((1.0, -0.2, np.pi))


@pytest.fixture(scope="module")
def kinematics():
    return Kinematics(BAXTER)


def angle(a, b):
    return np.arccos(np.clip(a @ b, -1.0, 1.0))


def poses_in_front(count, seed=0):
    """Hand poses over the bed's near half as a dressing robot meets them: from above, ahead and between."""
    generator = np.random.default_rng(seed)
    for n in range(count):
        position = generator.uniform((-0.05, -0.6, 0.65), (0.35, 0.2, 1.2))
        approach = (-np.sin(tilt := generator.uniform(0.0, np.pi / 2)), generator.uniform(-0.3, 0.3), -np.cos(tilt))
        side = SIDES[n % 2]
        if (position[1] < -0.2) == (side == "right"):  # facing -x, the left hand works towards -y
            position[1] = -0.4 - position[1]
        yield side, position, np.array(approach), generator.uniform(-1, 1, 3)


def test_success_rate_and_accuracy_in_front_of_the_robot(kinematics):
    reached = {"approach": 0, "none": 0}
    for side, position, approach, closing in poses_in_front(150):
        for free in reached:
            pose = hand_pose(position, approach, closing)
            try:
                q = solve_ik(kinematics, side, pose, BASE, model.READY[SIDES.index(side)], free=free)
            except Unreachable:
                continue
            reached[free] += 1
            hand = kinematics.pose_hand_in_map(side, q, BASE)
            assert np.linalg.norm(hand[:3, 3] - position) < 1e-3
            assert angle(hand[:3, 2], pose[:3, 2]) < 0.006
            if free == "none":
                assert angle(hand[:3, 1], pose[:3, 1]) < 0.006
            limits = kinematics.limits[side]
            assert (q >= limits.lower).all()
            assert (q <= limits.upper).all()
    assert reached["approach"] >= 0.93 * 150
    assert reached["none"] >= 0.93 * 150


def test_poses_of_random_postures_are_found_again(kinematics):
    generator = np.random.default_rng(4)
    found = 0
    for n in range(60):
        side = SIDES[n % 2]
        limits = kinematics.limits[side]
        pose = kinematics.pose_hand_in_map(side, generator.uniform(limits.lower, limits.upper), BASE)
        try:
            solve_ik(kinematics, side, pose, BASE, model.READY[n % 2])
            found += 1
        except Unreachable:
            pass
    assert found >= 58


def test_a_small_move_keeps_the_posture(kinematics):
    q = np.array((0.2, -0.4, -1.2, 1.5, 0.9, 1.0, 0.4))
    pose = kinematics.pose_hand_in_map("left", q, BASE)
    pose[:3, 3] += (0.01, 0.0, 0.01)
    assert np.abs(solve_ik(kinematics, "left", pose, BASE, q, seeds=1) - q).max() < 0.08


@pytest.mark.parametrize(("free", "column"), [("approach", 2), ("closing", 1)])
def test_the_free_axis_still_points_where_asked(kinematics, free, column):
    pose = hand_pose((0.3, 0.0, 0.8), (-0.4, 0.0, -1.0), (0.0, 1.0, 0.0))
    q = solve_ik(kinematics, "right", pose, BASE, model.READY[1], free=free)
    assert angle(kinematics.pose_hand_in_map("right", q, BASE)[:3, column], pose[:3, column]) < 0.006


def test_out_of_reach_says_how_far(kinematics):
    with pytest.raises(Unreachable, match="left hand cannot reach") as caught:
        solve_ik(kinematics, "left", hand_pose((-1.0, 0.0, 0.8), (-1, 0, 0)), BASE, model.READY[0], free="any")
    assert 0.3 < caught.value.position_residual < 1.2
    assert caught.value.q.shape == (7,)


def test_refused_postures_are_not_returned(kinematics):
    pose = hand_pose((0.3, 0.0, 0.8), (0, 0, -1))
    with pytest.raises(Unreachable, match="refused"):
        solve_ik(kinematics, "right", pose, BASE, model.READY[1], free="approach", accept=lambda q: False)
    low_elbow = solve_ik(kinematics, "right", pose, BASE, model.READY[1], free="approach", accept=lambda q: q[2] < 0.5)
    assert low_elbow[2] < 0.5


def test_hand_pose_is_a_rotation_that_points_and_closes_as_asked():
    pose = hand_pose((1, 2, 3), (0, 0, -2), (1, 0, 0.5))
    np.testing.assert_allclose(pose[:3, :3].T @ pose[:3, :3], np.eye(3), atol=1e-12)
    assert np.linalg.det(pose[:3, :3]) == pytest.approx(1.0)
    np.testing.assert_allclose(pose[:3, 2], (0, 0, -1))
    np.testing.assert_allclose(pose[:3, 1], (1, 0, 0))
    with pytest.raises(ValueError, match="parallel"):
        hand_pose((0, 0, 0), (0, 0, 1), (0, 0, 2))
    with pytest.raises(ValueError, match="zero"):
        hand_pose((0, 0, 0), (0, 0, 0))


def test_an_unknown_free_axis_is_told_the_choices(kinematics):
    with pytest.raises(ValueError, match="closing"):
        solve_ik(kinematics, "left", np.eye(4), BASE, model.READY[0], free="roll")


def test_half_a_turn_exchanges_the_fingers():
    pose = hand_pose((1, 2, 3), (0, 1, -2), (1, 0, 0.5))
    turned = half_turned(pose)
    np.testing.assert_allclose(turned[:3, 2:], pose[:3, 2:])
    np.testing.assert_allclose(turned[:3, 1], -pose[:3, 1])
    assert np.linalg.det(turned) == pytest.approx(1.0)
