"""What a simulated arm does when its joints are driven one by one, as a driver of a real one does."""

import numpy as np
import pytest
from caretree.sim.abilities import TakesJointVelocities
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.mechanics.servo import Servo
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import JointTrajectory

RATES = np.array((0.1, 0.0, 0.0, 0.0, 0.0, 0.0, -0.2))


def test_scripted_joints_move_for_their_time_and_then_hold():
    world = ScriptedWorld(stopping_time=0.0)
    assert isinstance(world, TakesJointVelocities)
    world.send_joint_velocities("right", RATES, 0.5)
    world.clock.wait_until(2.0)
    assert np.allclose(world.observe().arm_positions, (np.zeros(7), 0.5 * RATES))


@pytest.mark.parametrize("ends", ["stop", "trajectory"])
def test_something_else_ends_it(ends):
    world = ScriptedWorld(stopping_time=0.0)
    world.send_joint_velocities("left", RATES, 5.0)
    world.clock.wait_until(1.0)
    if ends == "stop":
        world.stop()
    else:
        still = np.array(((0.0,), (0.0,)))
        world.send(JointTrajectory(joints=("left_e0",), times=np.array((0.0, 0.1)), positions=still))
    world.clock.wait_until(3.0)
    assert np.allclose(world.observe().arm_positions[0], RATES, atol=0.01)


def test_a_servo_speeds_up_and_brakes_as_its_motors_can():
    servo = Servo(kinematics_of(BAXTER), np.zeros(3), model.READY)
    servo.move_joints("left", RATES, 0.3)
    servo.advance(0.01)
    assert np.allclose(servo.velocities[0], 0.01 * model.ARM_ACCELERATION[0])
    servo.advance(0.25)
    assert np.allclose(servo.velocities[:7], RATES)
    servo.advance(1.0)
    assert not servo.velocities.any()
    moved = servo.positions[:7] - model.READY[0]
    assert np.allclose(moved, 0.3 * RATES, atol=0.01)
