from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.mechanics.kinematics import Kinematics, kinematics_of
from caretree.sim.mechanics.planar import planar_pose
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import CAMERAS, SIDES


@pytest.fixture(scope="module")
def kinematics():
    return Kinematics(BAXTER)


def random_arms(kinematics, count, seed=0):
    generator = np.random.default_rng(seed)
    limits = [kinematics.limits[side] for side in SIDES]
    return [np.stack([generator.uniform(limit.lower, limit.upper) for limit in limits]) for _ in range(count)]


@pytest.mark.parametrize("side", SIDES)
def test_jacobian_is_the_derivative_of_the_hand_pose(kinematics, side):
    base, step = np.array((0.7, -0.3, 2.0)), 1e-6
    for arms in random_arms(kinematics, 5):
        q = arms[SIDES.index(side)]
        jacobian = kinematics.jacobian_hand_in_map(side, q, base)
        pose = kinematics.pose_hand_in_map(side, q, base)
        for joint in range(7):
            moved = kinematics.pose_hand_in_map(side, q + step * np.eye(7)[joint], base)
            turn = (moved[:3, :3] - pose[:3, :3]) @ pose[:3, :3].T / step
            np.testing.assert_allclose((moved[:3, 3] - pose[:3, 3]) / step, jacobian[:3, joint], atol=1e-5)
            np.testing.assert_allclose((turn[2, 1], turn[0, 2], turn[1, 0]), jacobian[3:, joint], atol=1e-5)


def test_local_jacobian_and_pose_are_those_of_the_same_angles(kinematics):
    for arms in random_arms(kinematics, 4, seed=1):
        pose, jacobian = kinematics.pose_and_jacobian_local("left", arms[0])
        np.testing.assert_allclose(pose.homogeneous, kinematics.pose_hand_in_base("left", arms[0]), atol=1e-12)
        in_base = kinematics.jacobian_hand_in_base("left", arms[0])
        np.testing.assert_allclose(pose.rotation @ jacobian[:3], in_base[:3], atol=1e-12)


def test_arm_models_agree_with_the_whole_robot(kinematics):
    base = np.array((-0.4, 1.1, -2.2))
    for arms in random_arms(kinematics, 4, seed=2):
        poses = kinematics.link_poses(kinematics.configuration(base, arms, 0.3))
        for n, side in enumerate(SIDES):
            hand = kinematics.pose_hand_in_map(side, arms[n], base)
            np.testing.assert_allclose(hand, poses[f"{side}_hand"], atol=1e-9)
        for camera in CAMERAS:
            np.testing.assert_allclose(
                kinematics.pose_camera_in_map(camera, base, arms, 0.3), poses[f"{camera}_camera"], atol=1e-9
            )


def test_mounting_is_what_the_document_says(kinematics):
    poses = kinematics.link_poses(kinematics.configuration(np.zeros(3), model.READY))
    assert poses["left_lower_shoulder"][2, 3] == pytest.approx(1.25, abs=0.01)
    hand, gripper = poses["right_hand"], poses["right_gripper"]
    np.testing.assert_allclose(hand[:3, 3] - gripper[:3, 3], model.FLANGE_TO_FINGERTIP * hand[:3, 2], atol=1e-9)


def test_fingers_move_apart_along_y_and_meet_at_the_hand(kinematics):
    opened = kinematics.link_poses(kinematics.configuration(np.zeros(3), model.READY, 0.0, np.array((0.06, 0.0))))
    apart = opened["left_finger_a_link"][:3, 3] - opened["left_finger_b_link"][:3, 3]
    np.testing.assert_allclose(apart, 0.06 * opened["left_hand"][:3, 1], atol=1e-9)
    np.testing.assert_allclose(opened["right_finger_a_link"][:3, 3], opened["right_hand"][:3, 3], atol=1e-9)


def test_cameras_look_where_they_should(kinematics):
    poses = kinematics.link_poses(kinematics.configuration(np.array((0, 0, np.pi / 2)), model.READY))
    head = poses["head_camera"]
    np.testing.assert_allclose(head[:3, 0], (1, 0, 0), atol=1e-9)  # facing +y, image right is +x
    assert np.arcsin(-head[2, 2]) == pytest.approx(model.HEAD_CAMERA_PITCH, abs=1e-6)
    for side in SIDES:
        camera, hand = poses[f"{side}_hand_camera"], poses[f"{side}_hand"]
        tip = np.linalg.inv(camera) @ hand[:, 3]
        assert abs(tip[0]) < 1e-9  # between the fingers, in the middle of the image's width
        assert tip[2] > 0.05
        assert abs(np.arctan2(tip[1], tip[2])) < np.deg2rad(20)


def test_both_arms_are_mirror_images(kinematics):
    mirror = np.diag((1.0, -1.0, 1.0))
    left, right = (kinematics.pose_hand_in_base(side, model.READY[n]) for n, side in enumerate(SIDES))
    np.testing.assert_allclose(mirror @ left[:3, 3], right[:3, 3], atol=1e-4)


def test_accelerations_leave_the_motors_most_of_their_torque(kinematics):
    for arms in random_arms(kinematics, 30, seed=5):
        q = kinematics.configuration(np.zeros(3), arms)
        gravity = kinematics.gravity_torque(q)
        for signs in (np.ones(7), np.array((1, -1, 1, -1, 1, -1, 1))):
            motion = np.tile(signs * model.ARM_ACCELERATION, (2, 1))
            torque = kinematics.inverse_dynamics(q, np.zeros((2, 7)), motion) - gravity
            assert (np.abs(torque) < 0.6 * kinematics.limits["left"].effort).all()


def test_unknown_camera_is_told_what_there_is(kinematics):
    with pytest.raises(ValueError, match="left_hand"):
        kinematics.pose_camera_in_map("belly", np.zeros(3), model.READY, 0.0)


def test_planar_pose_turns_left_for_positive_yaw():
    np.testing.assert_allclose(planar_pose(np.array((1.0, 2.0, np.pi / 2)))[:3, :3] @ (1, 0, 0), (0, 1, 0), atol=1e-12)


def test_the_margin_is_that_of_the_joint_nearest_to_its_limit(kinematics):
    limits = kinematics.limits["right"]
    q = 0.5 * (limits.lower + limits.upper)
    q[3] = limits.upper[3] - 0.12
    assert limits.margin(q) == pytest.approx(0.12)
    q[5] = limits.lower[5] - 0.01
    assert limits.margin(q) == pytest.approx(-0.01)


def test_there_is_one_for_each_robot():
    assert kinematics_of(BAXTER) is kinematics_of(BAXTER)
    other = replace(BAXTER, name="other")
    assert kinematics_of(other) is not kinematics_of(BAXTER)
    assert kinematics_of(other).robot is other


@pytest.mark.parametrize("side", SIDES)
def test_many_postures_at_once_are_those_one_by_one_to_the_last_bit(kinematics, side):
    base, n = np.array((0.7, -0.3, 2.0)), SIDES.index(side)
    q = np.array(random_arms(kinematics, 30))[:, n]
    rates = np.random.default_rng(1).normal(size=q.shape)
    places = [kinematics.pose_hand_in_map(side, each, base)[:3, 3] for each in q]
    assert np.array_equal(kinematics.places_of_hand_in_map(side, q, base), places)
    velocities = [
        kinematics.jacobian_hand_in_base(side, *each)[:3] @ rate for *each, rate in zip(q, rates, strict=True)
    ]
    assert np.array_equal(kinematics.velocities_of_hand_in_base(side, q, rates), velocities)


def test_many_joint_vectors_at_once_are_those_one_by_one(kinematics):
    base, opening, arms = np.array((0.7, -0.3, 2.0)), np.array((0.02, 0.05)), random_arms(kinematics, 5)
    each = [kinematics.configuration(base, posture, 0.3, opening) for posture in arms]
    assert np.array_equal(kinematics.configurations(base, np.array(arms), 0.3, opening), each)
