"""Cameras and the other senses in the simulated room, in worlds where they err."""

import numpy as np
import pytest
from caretree.sim.bullet.world import BulletWorld
from caretree.sim.errors import CaretreeError
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import CAMERAS, BaseVelocity, HandTwist, JointTrajectory, SensorLost
from caretree.sim.world_kind import DIFFICULTIES

SENSES = [one for one in DIFFICULTIES if one not in ("falling_arms", "thinking_time", "skin_friction")]


def passed(kind, seconds=0.4):
    """A world whose base has been driving for a while, with its truth, what it senses and an image of it."""
    world = BulletWorld(seed=100, kind=kind)
    world.send(BaseVelocity(velocity=np.array((0.2, 0.0, 0.3)), duration=10.0))
    while world.clock.now() < seconds - 1e-9:
        world.clock.wait_until(min(world.clock.now() + 0.05, seconds))
        world.observe()
    return world, world.truth_frame(), world.observe(), world.look("head")


@pytest.fixture(scope="module")
def easy():
    world, *seen = passed("easy")
    world.close()
    return seen


@pytest.mark.parametrize("difficulty", SENSES)
def test_an_error_of_the_senses_changes_neither_truth_nor_any_other_sense(easy, difficulty):
    world, truth, seen, frame = passed(f"easy+{difficulty}")
    world.close()
    easy_truth, easy_seen, easy_frame = easy
    for name, value in vars(easy_truth).items():
        np.testing.assert_array_equal(getattr(truth, name), value, err_msg=name)
    same = {
        "arm_positions": difficulty != "encoders",
        "pose_base_in_map": difficulty != "localisation",
        "pose_hand_in_map": difficulty not in ("encoders", "localisation"),
        "wrench_hand_in_map": difficulty not in ("encoders", "localisation", "wrench_bias"),
    }
    for name, equal in same.items():
        assert np.array_equal(getattr(seen, name), getattr(easy_seen, name)) == equal, name
    assert (frame.stamp == easy_frame.stamp) == (difficulty != "late_images")
    drawn_alike = difficulty in ("encoders", "localisation", "wrench_bias", "depth_noise")
    assert np.array_equal(frame.rgb, easy_frame.rgb) == drawn_alike
    same_pose = difficulty not in ("encoders", "localisation", "late_images")
    assert np.array_equal(frame.pose_camera_in_map, easy_frame.pose_camera_in_map) == same_pose


def test_a_late_image_is_the_one_of_its_time_with_the_pose_of_that_time(easy):
    world, _, _, frame = passed("easy+late_images")
    world.close()
    age = 0.4 - frame.stamp
    assert 0.05 <= age <= 0.15
    then, _, _, before = passed("easy", seconds=frame.stamp)
    then.close()
    assert before.stamp == pytest.approx(frame.stamp)
    np.testing.assert_allclose(before.pose_camera_in_map, frame.pose_camera_in_map, atol=1e-9)
    differs = np.abs(frame.rgb.astype(int) - before.rgb).mean()
    assert differs < 4.0, "but for the sensor's noise"
    assert differs < 0.7 * np.abs(frame.rgb.astype(int) - easy[2].rgb).mean()


def test_commands_are_off_as_the_senses_are():
    world = BulletWorld(seed=100, kind="easy+encoders+localisation")
    joints = BAXTER.joints_of("left")
    start = world.observe()
    goal = start.arm_positions[0] + 0.1
    sent = world.send(
        JointTrajectory(joints=joints, times=np.array((0.0, 1.0)), positions=np.stack((start.arm_positions[0], goal)))
    )
    np.testing.assert_allclose(sent.positions[-1], goal, atol=1e-12)
    twist = HandTwist(side="right", twist_in_map=np.array((0.05, 0.0, 0.0, 0.0, 0.0, 0.0)), duration=1.0)
    np.testing.assert_allclose(world.send(twist).twist_in_map, twist.twist_in_map, atol=1e-12)
    hand = world.truth_frame().gripper_pose[1, :3]
    world.clock.wait_until(1.5)
    reached = world._robot.read().arm_positions[0]
    assert world.observe().arm_positions[0] == pytest.approx(goal, abs=1e-3)
    off = np.rad2deg(np.abs(reached - goal))
    assert 0.1 < off.max() <= 0.25
    way = world.truth_frame().gripper_pose[1, :3] - hand
    turned = -world._errors._localisation.error(0.0)[2]
    assert np.arctan2(way[1], way[0]) == pytest.approx(turned, abs=0.004)
    world.close()


def test_all_errors_at_once_are_the_same_for_the_same_seed():
    runs = []
    for _ in range(2):
        world, truth, seen, frame = passed("hard", seconds=0.2)
        runs.append((truth.vertices, *vars(seen).values(), frame.rgb, frame.depth, frame.pose_camera_in_map))
        world.close()
    for one, other in zip(*runs, strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_camera_that_does_not_exist_is_lost_and_all_others_see():
    world = BulletWorld(seed=101, kind="easy+late_images+camera_extrinsics")
    for camera in CAMERAS:
        assert world.look(camera).stamp == 0.0
    with pytest.raises(SensorLost, match="right_hand"):
        world.look("rear")
    world.close()


def test_an_unknown_kind_is_one_sentence():
    with pytest.raises(CaretreeError, match="depth_noise"):
        BulletWorld(seed=100, kind="easy+fog")
