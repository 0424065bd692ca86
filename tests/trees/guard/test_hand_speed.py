"""How fast a trajectory moves a hand near the person."""

import numpy as np
import pytest
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.linear_arm import LinearArms
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import JointTrajectory
from caretree.skills.geometry.person_zone import PersonZone
from caretree.trees.guard.hand_speed import near_speed, sampled, stretched
from caretree.trees.guard.link_motion import LinkMotion

AHEAD = JointTrajectory(joints=("left_s0",), times=np.array((0.0, 2.0)), positions=np.array(((0.0,), (0.8,))))
TIMES = np.array((0.0, 1.0, 2.0, 3.0))  # [s]
PATH = np.array(((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.2, 0.0, 0.0), (4.2, 0.0, 0.0)))  # [m]: 1.0, 0.2, 3.0 m/s


THIN = np.zeros(1)  # one link that is a point


def zone_at(place):
    zone = PersonZone(np.zeros((2, 3)))
    zone.update(np.asarray(place, float), part="head", radius=0.0)
    return zone


def test_the_path_of_a_hand_is_that_of_its_kinematics():
    seen = ScriptedWorld().observe()
    times, path = LinkMotion(BAXTER, LinearArms()).hand_path(AHEAD, "left", seen)
    assert times[[0, -1]] == pytest.approx((0.0, 2.0))
    assert np.linalg.norm(path[-1] - path[0]) == pytest.approx(0.4)  # [m]: half a metre for each radian
    assert LinkMotion(BAXTER, LinearArms()).hand_path(AHEAD, "right", seen) is None


def test_samples_are_close_together_and_hold_every_knot():
    trajectory = JointTrajectory(
        joints=("left_s0", "left_s1"), times=np.array((0.0, 0.33, 1.0)), positions=np.array(((0, 0), (1, 2), (1, 0.0)))
    )
    times, positions = sampled(trajectory)
    assert np.diff(times).max() <= 0.0501  # [s]
    assert positions[np.flatnonzero(np.isclose(times, 0.33))] == pytest.approx(np.array([[1.0, 2.0]]))


def ends_of(path):
    return np.repeat(path[:, None, None], 2, axis=2)


def test_only_steps_near_the_person_count():
    assert near_speed(TIMES, ends_of(PATH), THIN, zone_at((1.1, 0.0, 0.0)), near=0.15) == pytest.approx(
        3.0
    )  # leaves at 3 m/s
    assert near_speed(TIMES, ends_of(PATH), THIN, zone_at((0.0, 0.1, 0.0)), near=0.15) == pytest.approx(1.0)
    assert near_speed(TIMES, ends_of(PATH), THIN, zone_at((0.0, 9.0, 0.0)), near=0.15) == 0.0


def test_stretched_is_the_same_path_slower():
    slow = stretched(AHEAD, 3.0)
    assert slow.times == pytest.approx((0.0, 6.0))  # [s]
    assert slow.positions == pytest.approx(AHEAD.positions)
