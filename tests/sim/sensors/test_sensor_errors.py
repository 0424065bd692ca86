"""All that lies between the truth and the senses."""

import numpy as np
import pytest
from caretree.sim.robot.body import JointReading
from caretree.sim.sensors.sensor_changes import SensorChanges
from caretree.sim.sensors.sensor_errors import SensorErrors
from caretree.sim.world import BaseVelocity, HandTwist, JointTrajectory
from caretree.sim.world_kind import DIFFICULTIES, EASY_KIND, WorldKind

READING = JointReading(
    arm_positions=np.zeros((2, 7)),
    arm_velocities=np.zeros((2, 7)),
    motor_torques=np.zeros((2, 7)),
    head_pan=0.0,
    pose_base_in_map=np.zeros(3),
    twist_base=np.zeros(3),
    gripper_opening=np.zeros(2),
    gripper_force=np.zeros(2),
)
POSES = np.tile(np.eye(4), (2, 1, 1))
DEPTH = np.ones((30, 40), dtype=np.float32)
COMMANDS = (
    JointTrajectory(joints=("left_s0",), times=np.array((0.0, 1.0)), positions=np.zeros((2, 1))),
    HandTwist(side="left", twist_in_map=np.ones(6)),
    BaseVelocity(velocity=np.ones(3)),
)


def senses(seed, kind):
    """What is read at 2 s, in one row each."""
    errors = SensorErrors(seed, WorldKind.named(kind))
    reading = errors.joints(READING, 2.0)
    return {
        "encoders": np.append(reading.arm_positions, reading.head_pan),
        "localisation": reading.pose_base_in_map,
        "wrench_bias": errors.wrench(np.zeros((2, 6)), POSES, POSES, 2.0),
        "camera_extrinsics": errors.pose_camera("head", np.eye(4)),
        "depth_noise": errors.depth(DEPTH),
        "late_images": errors.late and list(errors.late.latency.values()),
    }


def test_the_easy_world_passes_everything_through_untouched():
    errors, wrench, pose = SensorErrors(100, EASY_KIND), np.zeros((2, 6)), np.eye(4)
    assert errors.joints(READING, 1.0) is READING
    assert errors.wrench(wrench, POSES, POSES, 1.0) is wrench
    assert errors.pose_camera("head", pose) is pose
    assert errors.depth(DEPTH) is DEPTH
    assert errors.late is None
    for command in COMMANDS:
        assert errors.executed(command, 1.0) is command
        assert errors.told(command, 1.0) is command


OTHERS = ("falling_arms", "thinking_time", "skin_friction")  # difficulties that are none of the senses


@pytest.mark.parametrize("difficulty", [one for one in DIFFICULTIES if one not in OTHERS])
def test_each_error_is_there_alone_and_the_same_alone_as_with_all_others(difficulty):
    easy, alone, hard = senses(100, "easy"), senses(100, f"easy+{difficulty}"), senses(100, "hard")
    for name, value in alone.items():
        assert (name == difficulty) != np.array_equal(value, easy[name]), name
    np.testing.assert_allclose(alone[difficulty], hard[difficulty])
    other = senses(101, f"easy+{difficulty}")
    assert not np.array_equal(other[difficulty], alone[difficulty])


def test_a_command_is_told_as_it_was_asked_for_and_done_otherwise():
    errors = SensorErrors(100, WorldKind.named("easy+encoders+localisation"))
    trajectory, twist, base = (errors.executed(command, 1.0) for command in COMMANDS)
    assert (trajectory.positions != 0.0).all()
    assert not np.array_equal(twist.twist_in_map, np.ones(6))
    assert base is COMMANDS[2]
    np.testing.assert_allclose(errors.told(trajectory, 1.0).positions, 0.0)
    np.testing.assert_allclose(errors.told(twist, 1.0).twist_in_map, 1.0)


def test_orientation_that_is_off_turns_the_wrench():
    errors = SensorErrors(100, WorldKind.named("easy+localisation"))
    turned = POSES.copy()
    turned[:, :2, :2] = ((0.0, -1.0), (1.0, 0.0))  # taken to be turned left by 90 degrees
    pull = np.tile((1.0, 0.0, 0.0, 0.0, 0.0, 0.0), (2, 1))
    np.testing.assert_allclose(errors.wrench(pull, POSES, turned, 1.0)[:, :3], ((0.0, 1.0, 0.0),) * 2, atol=1e-12)


def test_a_model_files_offset_moves_the_heads_camera_along_its_own_axes_in_any_world():
    taken = np.eye(4)
    taken[:3, :3] = [[0, 0, 1], [-1, 0, 0], [0, -1, 0]]  # looks along x
    changes = SensorChanges(camera=np.array((0.01, 0.0, 0.03)))
    for kind in ("easy", "hard"):
        plain, moved = (
            SensorErrors(100, WorldKind.named(kind)),
            SensorErrors(100, WorldKind.named(kind), changes=changes),
        )
        there = plain.pose_camera("head", taken)
        away = moved.pose_camera("head", taken)[:3, 3] - there[:3, 3]
        np.testing.assert_allclose(away, there[:3, :3] @ changes.camera, atol=1e-12)
        np.testing.assert_array_equal(moved.pose_camera("left_hand", taken), plain.pose_camera("left_hand", taken))


def test_a_late_wrench_is_what_pulled_a_while_ago_straight_between_samples():
    errors = SensorErrors(100, EASY_KIND, changes=SensorChanges(delay=0.15))
    told = [
        errors.wrench(np.full((2, 6), 10.0 * time), POSES, POSES, time)[0, 0] for time in (0.0, 0.1, 0.1, 0.2, 0.3, 0.4)
    ]
    assert told == pytest.approx((0.0, 0.0, 0.0, 0.5, 1.5, 2.5))
