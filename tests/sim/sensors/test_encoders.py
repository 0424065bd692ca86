"""Joint sensors whose zero is off."""

from types import SimpleNamespace

import numpy as np
from caretree.sim.robot.body import JointReading
from caretree.sim.scene.difficulties import stream
from caretree.sim.sensors.encoders import Encoders
from caretree.sim.world import JointTrajectory

ALL = np.array([Encoders(stream(seed, "encoders")).offsets for seed in range(100, 200)])


def reading():
    return JointReading(
        arm_positions=np.arange(14.0).reshape(2, 7),
        arm_velocities=np.ones((2, 7)),
        motor_torques=np.ones((2, 7)),
        head_pan=0.3,
        pose_base_in_map=np.array((1.0, 2.0, 0.5)),
        twist_base=np.zeros(3),
        gripper_opening=np.full(2, 0.05),
        gripper_force=np.zeros(2),
    )


def test_zeros_are_off_by_at_most_a_fifth_of_a_degree_and_differ_by_joint_and_seed():
    off = np.rad2deg(ALL)
    assert 0.19 < np.abs(off).max() <= 0.2
    assert np.abs(off.mean(axis=0)).max() < 0.04
    assert np.allclose(off.std(axis=0), 0.2 / np.sqrt(3), atol=0.02)
    assert len(np.unique(off)) == off.size


def test_joints_are_read_with_their_offset_and_nothing_else_changes():
    encoders, before = Encoders(stream(100, "encoders")), reading()
    seen = encoders.measured(before)
    np.testing.assert_allclose((seen.arm_positions - before.arm_positions).ravel(), encoders.offsets[:14])
    assert np.isclose(seen.head_pan - before.head_pan, encoders.offsets[14])
    for same in ("arm_velocities", "motor_torques", "pose_base_in_map", "gripper_opening"):
        assert getattr(seen, same) is getattr(before, same)
    np.testing.assert_array_equal(before.arm_positions, reading().arm_positions)


def test_a_motor_goes_where_its_sensor_reads_what_was_asked_for():
    encoders = Encoders(stream(101, "encoders"))
    asked = JointTrajectory(
        joints=("right_w2", "head_pan", "left_s0"), times=np.array((0.0, 1.0)), positions=np.ones((2, 3))
    )
    angles = encoders.angles(asked).positions[-1]
    stands = SimpleNamespace(arm_positions=np.zeros((2, 7)), head_pan=angles[1])
    stands.arm_positions[1, 6], stands.arm_positions[0, 0] = angles[0], angles[2]
    before = reading()
    seen = encoders.measured(JointReading(**{**vars(before), **vars(stands)}))
    np.testing.assert_allclose((seen.arm_positions[1, 6], seen.head_pan, seen.arm_positions[0, 0]), 1.0)
    np.testing.assert_allclose(encoders.readings(encoders.angles(asked)).positions, asked.positions)
