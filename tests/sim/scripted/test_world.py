import numpy as np
import pytest
from caretree.sim.abilities import SupportsForks
from caretree.sim.scripted.exact_twist import pseudo_inverse
from caretree.sim.scripted.linear_arm import LinearArms
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import BaseVelocity, GripperOpening, HandTwist, JointTrajectory, SensorLost


def trajectory(*goal, joints=("left_s0", "right_w2"), duration=2.0):
    path = np.array((np.zeros(len(goal)), goal))
    return JointTrajectory(joints=joints, times=np.array((0.0, duration)), positions=path)


def test_trajectories_are_followed_in_time_and_reached():
    world = ScriptedWorld()
    world.send(trajectory(0.4, -0.2))
    world.clock.wait_until(1.0)
    seen = world.observe()
    assert seen.time == pytest.approx(1.0)
    assert seen.arm_positions[0, 0] == pytest.approx(0.2)
    assert seen.arm_velocities[0, 0] == pytest.approx(0.2)
    world.clock.wait_until(2.5)
    seen = world.observe()
    assert (seen.arm_positions[0, 0], seen.arm_positions[1, 6]) == (pytest.approx(0.4), pytest.approx(-0.2))
    assert np.abs(seen.arm_velocities).max() == 0.0


def test_the_head_turns():
    world = ScriptedWorld()
    world.send(trajectory(0.3, joints=("head_pan",)))
    world.clock.wait_until(3.0)
    assert world.observe().head_pan == pytest.approx(0.3)


def test_a_twist_moves_the_hand_for_its_duration():
    world = ScriptedWorld()
    start = world.observe().pose_hand_in_map[1]
    world.send(HandTwist(side="right", twist_in_map=np.array((0.1, 0, 0.05, 0, 0, 0.2)), duration=1.0))
    world.clock.wait_until(3.0)
    pose = world.observe().pose_hand_in_map[1]
    np.testing.assert_allclose(pose[:3, 3] - start[:3, 3], (0.1, 0, 0.05), atol=1e-6)
    turned = pose[:3, :3] @ start[:3, :3].T
    assert np.arctan2(turned[1, 0], turned[0, 0]) == pytest.approx(0.2, abs=1e-3)


def test_a_new_command_replaces_the_old_one_of_the_same_arm_only():
    world = ScriptedWorld()
    world.send(trajectory(0.4, joints=("left_s0",)))
    world.send(trajectory(0.4, joints=("right_s0",)))
    world.clock.wait_until(0.5)
    world.send(trajectory(0.0, joints=("left_s0",), duration=1.0))
    world.clock.wait_until(3.0)
    assert world.observe().arm_positions[:, 0] == pytest.approx((0.0, 0.4))


def test_a_stop_takes_its_time():
    world = ScriptedWorld(stopping_time=0.2)
    world.send(trajectory(0.8, joints=("left_s0",)))
    world.send(BaseVelocity(velocity=np.array((0.1, 0, 0.1)), duration=5.0))
    world.clock.wait_until(1.0)
    world.stop()
    world.stop()
    world.clock.wait_until(1.1)
    seen = world.observe()
    assert 0.0 < seen.arm_velocities[0, 0] < 0.4
    assert 0.0 < seen.twist_base[2] < 0.1
    world.clock.wait_until(1.3)
    stood = world.observe()
    assert np.abs(stood.arm_velocities).max() == 0.0
    assert np.abs(stood.twist_base).max() == 0.0
    world.clock.wait_until(3.0)
    np.testing.assert_array_equal(stood.arm_positions, world.observe().arm_positions)
    np.testing.assert_array_equal(stood.pose_base_in_map, world.observe().pose_base_in_map)


def test_the_base_drives_in_its_own_frame_and_carries_the_hands():
    world = ScriptedWorld()
    start = world.observe()
    world.send(BaseVelocity(velocity=np.array((0.2, 0.0, 0.0)), duration=1.0))
    world.clock.wait_until(2.0)
    seen = world.observe()
    # the base looks along y
    np.testing.assert_allclose(seen.pose_base_in_map - start.pose_base_in_map, (0, 0.2, 0), atol=2e-3)
    np.testing.assert_allclose(
        seen.pose_hand_in_map[:, :3, 3] - start.pose_hand_in_map[:, :3, 3], ((0, 0.2, 0),) * 2, atol=2e-3
    )


def test_fingers_close_on_what_is_between_them():
    world = ScriptedWorld()
    world.between_fingers["left"] = 0.02
    for side in ("left", "right"):
        world.send(GripperOpening(side=side, opening=0.0, force_limit=12.0))
    world.clock.wait_until(2.0)
    seen = world.observe()
    assert seen.gripper_opening == pytest.approx((0.02, 0.0), abs=1e-6)
    assert tuple(seen.gripper_force) == (12.0, 0.0)
    world.fault_grip_slip("left")
    world.clock.wait_until(3.0)
    assert world.observe().gripper_opening[0] == pytest.approx(0.0, abs=1e-6)


def test_a_slip_of_an_empty_hand_changes_nothing():
    class Strange(ScriptedWorld):
        def fault_grip_slip(self, side):
            self.load[side] = np.ones(6)

    world = ScriptedWorld()
    assert isinstance(world, SupportsForks)
    assert world.slip_changes_nothing("left")
    assert not Strange().slip_changes_nothing("left"), "who knows what its faults do"
    world.load["left"] = np.ones(6)
    assert not world.slip_changes_nothing("left")
    world.fault_grip_slip("left")
    assert world.slip_changes_nothing("left")
    world.between_fingers["left"] = 0.01
    assert not world.slip_changes_nothing("left")


def test_who_asks_where_the_person_is_is_told_of():
    class Strange(ScriptedWorld):
        def fault_move_person(self):
            self.person_offset = np.ones(3)

    world, asked = ScriptedWorld(), []
    assert world.tell_of_person(lambda: asked.append(1))
    world.fault_move_person()
    assert not asked
    assert world.person_offset[0] == pytest.approx(0.1)
    assert len(asked) == 1
    assert not Strange().tell_of_person(lambda: None)


def test_noise_is_seeded_and_never_silent():
    one, two, other = ScriptedWorld(seed=3), ScriptedWorld(seed=3), ScriptedWorld(seed=4)
    first = one.observe().wrench_hand_in_map
    np.testing.assert_array_equal(first, two.observe().wrench_hand_in_map)
    assert not np.array_equal(first, other.observe().wrench_hand_in_map)
    assert not np.array_equal(first, one.observe().wrench_hand_in_map)
    assert not np.array_equal(one.look("head").depth, one.look("head").depth)
    with pytest.raises(SensorLost, match="there is no camera 'tail'"):
        one.look("tail")


def test_frames_and_loads_can_be_scripted():
    shown = []
    world = ScriptedWorld(frames=lambda camera, time: shown.append((camera, time)) or "frame")
    assert world.look("left_hand") == "frame"
    assert shown == [("left_hand", 0.0)]
    world.load["right"] = np.array((0, 0, -7.0, 0, 0, 0))
    assert world.observe().wrench_hand_in_map[1, 2] == pytest.approx(-7.0, abs=0.1)


def test_linear_arms_are_consistent():
    arms, rng = LinearArms(), np.random.default_rng(0)
    base = np.array((0.3, -0.4, 0.7))
    for side in ("left", "right"):
        q = rng.uniform(-0.5, 0.5, 7)
        jacobian = arms.jacobian_hand_in_map(side, q, base)
        for joint in range(7):
            step = np.zeros(7)
            step[joint] = 1e-6
            before, after = (arms.pose_hand_in_map(side, q + s * step, base) for s in (-1, 1))
            np.testing.assert_allclose((after - before)[:3, 3] / 2e-6, jacobian[:3, joint], atol=1e-6)
            spin = (after[:3, :3] - before[:3, :3]) / 2e-6 @ arms.pose_hand_in_map(side, q, base)[:3, :3].T
            np.testing.assert_allclose((spin[2, 1], spin[0, 2], spin[1, 0]), jacobian[3:, joint], atol=1e-6)


def test_the_pseudo_inverse_is_that_of_numpy_to_the_last_bit_singular_or_not():
    rng = np.random.default_rng(5)
    for rank in (6, 5, 3):
        jacobian = rng.normal(size=(6, rank)) @ rng.normal(size=(rank, 7))
        assert (pseudo_inverse(jacobian) == np.linalg.pinv(jacobian, rcond=1e-3)).all()
