"""Where the scripted world has a robot's own kinematics, hands move as the servo moves them and joints have limits."""

import numpy as np
import pytest
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.mechanics.servo import PERIOD, Servo
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import BaseVelocity, HandTwist, JointTrajectory

pytestmark = pytest.mark.extra

UPWARD = np.array((0.0, 0.0, 0.15, 0.0, 0.0, 0.0))


@pytest.fixture
def world():
    return ScriptedWorld(kinematics=kinematics_of(BAXTER), arm_positions=BAXTER.ready)


def margins(world):
    limits = kinematics_of(BAXTER).limits
    return [limits[side].margin(q) for side, q in zip(("left", "right"), world.observe().arm_positions, strict=True)]


def play(world, seconds, watch=lambda: None):
    ends = world.clock.now() + seconds
    while world.clock.now() < ends - 1e-9:
        world.clock.wait_until(world.clock.now() + PERIOD)
        watch()


@pytest.mark.parametrize("step", [PERIOD, 1.0 / 15.0, 1.0 / 3.0])
def test_a_twist_stops_at_the_limit_of_a_joint(world, step):
    limits = kinematics_of(BAXTER).limits["left"]
    command = HandTwist(side="left", twist_in_map=UPWARD, duration=step)
    while world.clock.now() < 12.0:
        world.send(command)
        world.clock.wait_until(world.clock.now() + step)
        seen = world.observe()
        assert limits.margin(seen.arm_positions[0]) >= 0.0
        assert (np.abs(seen.arm_velocities[0]) <= limits.velocity + 1e-9).all()
    assert limits.margin(world.observe().arm_positions[0]) < 0.01, "it never came to a limit"
    play(world, 1.0)
    assert np.abs(world.observe().arm_velocities).max() == 0.0


def test_a_twist_turns_the_joints_as_the_servo_does(world):
    seen = world.observe()
    servo = Servo(kinematics_of(BAXTER), seen.pose_base_in_map, seen.arm_positions)
    drive = BaseVelocity(velocity=np.zeros(3), duration=1.0)
    apart = []

    def watch():
        servo.advance(world.clock.now())
        apart.append(np.abs(world.observe().arm_positions.ravel() - servo.positions[:14]).max())

    for twist in ((0.05, 0.1, 0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.1, 0.3, 0.0, 0.5), (0.9, 0.0, 0.0, 0.0, 0.0, 0.0)):
        command = HandTwist(side="right", twist_in_map=np.array(twist), duration=0.5)
        taken, expected = world.send(command), servo.command(command)
        np.testing.assert_array_equal(taken.twist_in_map, expected.twist_in_map)
        for each in (world, servo):
            (each.send if each is world else each.command)(drive)
        play(world, 0.5, watch)
    assert max(apart) < 1e-9
    assert np.abs(world.observe().arm_positions[1] - BAXTER.ready[1]).max() > 0.05


def test_the_hand_stays_where_it_is_in_the_map_while_the_base_drives(world):
    start = world.observe().pose_hand_in_map[0]
    world.send(BaseVelocity(velocity=np.array((0.05, 0.0, 0.0)), duration=0.98))
    world.send(HandTwist(side="left", twist_in_map=np.zeros(6), duration=1.0))
    play(world, 0.99)
    seen = world.observe()
    assert np.linalg.norm(seen.pose_base_in_map[:2] - world.room.waypoints["start"][:2]) > 0.04
    np.testing.assert_allclose(seen.pose_hand_in_map[0], start, atol=1e-3)


def test_a_stop_ends_a_twist_within_the_limits(world):
    world.send(HandTwist(side="left", twist_in_map=UPWARD, duration=5.0))
    play(world, 1.0)
    world.stop()
    play(world, 0.5)
    stood = world.observe()
    assert np.abs(stood.arm_velocities).max() == 0.0
    play(world, 0.5)
    np.testing.assert_array_equal(world.observe().arm_positions, stood.arm_positions)


def test_a_trajectory_beyond_the_limits_is_clipped_and_slowed_and_says_so(world):
    limits, start = kinematics_of(BAXTER).limits["left"], BAXTER.ready[0]
    command = JointTrajectory(
        joints=model.arm_joints("left"), times=np.array((0.0, 0.1)), positions=np.stack((start, start + 9.0))
    )
    sent = world.send(command)
    np.testing.assert_array_equal(sent.positions[-1], limits.upper)
    assert sent.times[-1] > 0.5
    assert world.sent[-1] is sent
    play(world, sent.times[-1] + 0.1, lambda: np.testing.assert_array_less(-1e-12, margins(world)))
    np.testing.assert_allclose(world.observe().arm_positions[0], limits.upper)


def test_joints_that_are_driven_stop_at_their_limits(world):
    limits = kinematics_of(BAXTER).limits["right"]
    world.send_joint_velocities("right", np.full(7, 50.0), 60.0)
    play(world, 0.1)
    assert (np.abs(world.observe().arm_velocities[1]) <= limits.velocity + 1e-9).all()
    play(world, 10.0)
    np.testing.assert_array_equal(world.observe().arm_positions[1], limits.upper)


def test_a_new_twist_carries_on_from_the_old_one_and_a_trajectory_ends_it(world):
    command = HandTwist(side="left", twist_in_map=UPWARD, duration=0.3)
    for _ in range(3):
        world.send(command)
        play(world, 0.3)
    moving = np.abs(world.observe().arm_velocities[0]).max()
    assert moving > 0.02
    here = world.observe().arm_positions[0]
    hold = JointTrajectory(
        joints=model.arm_joints("left"), times=np.array((0.0, 0.5)), positions=np.stack((here, here))
    )
    world.send(hold)
    play(world, 1.0)
    np.testing.assert_allclose(world.observe().arm_positions[0], here, atol=1e-12)
