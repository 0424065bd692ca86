"""One joint of an arm turns at a given speed, and nothing else of it moves."""

import numpy as np
import pytest
from caretree.sim.world import JointTrajectory
from caretree.skills.core.reasons import Reason
from caretree.skills.move_joint import MoveJoint

from .hung_gown import bench_with, ended

W1 = 5  # index of the joint w1
START = np.full((2, 7), 0.2)  # [rad]


def bench(**ports):
    return bench_with(lambda context: MoveJoint("turn", context, side="left", joint="w1", **ports), arms=START)


@pytest.mark.parametrize(("relative", "goal"), [(True, 0.6), (False, 0.4)])
def test_turns_by_an_angle_or_to_one_and_says_where_it_was(relative, goal):
    run = bench(angle=0.4, relative=relative)
    assert ended(run) is None
    moved = START.copy()
    moved[0, W1] = goal
    assert run.world.observe().arm_positions == pytest.approx(moved, abs=0.01)  # [rad]
    assert run.skill.before == pytest.approx(0.2)


def test_takes_the_time_that_its_speed_asks_for():
    run = bench(angle=-1.0, speed=0.5)
    fastest = []
    assert ended(run, each_tick=lambda: fastest.append(np.abs(run.world.observe().arm_velocities).max())) is None
    assert max(fastest) == pytest.approx(0.5, rel=0.05)  # [rad/s]
    assert run.world.clock.now() == pytest.approx(2.0, abs=0.3)  # [s]


def test_a_lost_command_is_told():
    run = bench(angle=0.4)
    send = run.world.send
    run.world.send = lambda command: command if isinstance(command, JointTrajectory) else send(command)
    assert ended(run) == Reason.COMMAND_LOST
