import numpy as np
import pytest
from caretree.sim.mechanics.kinematics import Kinematics
from caretree.sim.mechanics.servo import Servo
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.robot.model import READY
from caretree.skills.motion.drive import PathFollower


@pytest.mark.parametrize("tick", [0.05, 0.1])
def test_the_follower_arrives_within_two_centimetres_and_two_degrees(tick):
    path = np.array(((1.5, -1.0), (1.3, 1.6), (-1.2, 1.6), (-1.2, 0.3)))
    servo = Servo(Kinematics(BAXTER), np.array((1.5, -1.0, np.pi)), READY)
    follower = PathFollower(path, 0.0, BAXTER.limits)
    now, last = 0.0, np.inf
    for _ in range(round(60 / tick)):
        if follower.done(servo.pose_base_in_map):
            break
        servo.command(follower.command(servo.pose_base_in_map))
        now += tick
        servo.advance(now)
        assert not np.all(np.abs(servo.pose_base_in_map[:2]) < (0.9, 1.35)), "it cuts no corner"
    assert now < np.linalg.norm(np.diff(path, axis=0), axis=1).sum() / 0.5 + 6.0
    for n in range(50):  # the last command runs out: it must not carry the base past its goal
        servo.advance(now + 0.01 * n)
    last = np.linalg.norm(servo.pose_base_in_map[:2] - (-1.2, 0.3))
    assert last < 0.025
    assert abs((servo.pose_base_in_map[2] + np.pi) % (2 * np.pi) - np.pi) < np.deg2rad(2.5)


def test_the_follower_is_done_only_with_the_right_heading():
    follower = PathFollower(np.array(((0.0, 0.0), (1.0, 0.0))), np.pi, BAXTER.limits)
    assert not follower.done(np.array((1.0, 0.0, 0.0)))
    assert follower.done(np.array((0.99, 0.01, -np.pi + 0.01)))
    turning = follower.command(np.array((1.0, 0.0, 0.0)))
    assert abs(turning.velocity[2]) > 0.3


def test_it_turns_only_near_the_end_when_told_so():
    follower = PathFollower(np.array(((0.0, 0.0), (2.0, 0.0))), 1.0, BAXTER.limits, turn_from=0.5)
    assert follower.command(np.array((0.0, 0.0, 0.0))).velocity[2] == 0.0
    for x in np.linspace(0.0, 1.7, 18):
        last = follower.command(np.array((x, 0.0, 0.0)))
    assert last.velocity[2] > 0.0


def test_the_velocity_is_that_of_the_base_frame():
    follower = PathFollower(np.array(((0.0, 0.0), (2.0, 0.0))), np.pi / 2, BAXTER.limits, speed=0.3)
    velocity = follower.command(np.array((0.0, 0.0, np.pi / 2))).velocity
    np.testing.assert_allclose(velocity, (0.0, -0.3, 0.0), atol=1e-9)


def test_a_path_that_is_none_is_refused():
    with pytest.raises(ValueError, match="corner points"):
        PathFollower(np.zeros(3), 0.0, BAXTER.limits)
