import numpy as np
import pytest
from caretree.sim.world import JointTrajectory
from caretree.skills.control.follow import follow, joint_values
from caretree.skills.core.reasons import Reason

from ..moving import carry_out, robot


def swing(world, by):
    """A trajectory of one joint of the left arm and the head, `by` [rad] in 2 s."""
    joints = ("left_s1", "head_pan")
    here = joint_values(world.robot, world.observe(), joints)
    return JointTrajectory(joints=joints, times=np.array((0.0, 2.0)), positions=np.stack((here, here + by)))


def test_it_ends_where_the_trajectory_ends_and_not_before():
    world, context = robot()
    trajectory = swing(world, 0.3)
    skill = carry_out(world, context, lambda skill: follow(skill, trajectory))
    assert skill.failure is None
    assert world.clock.now() >= 2.0
    np.testing.assert_allclose(
        joint_values(world.robot, world.observe(), trajectory.joints), trajectory.positions[-1], atol=0.01
    )


def test_a_command_that_moves_nothing_is_lost():
    world, context = robot(deaf_to=JointTrajectory)
    skill = carry_out(world, context, lambda skill: follow(skill, swing(world, 0.3)))
    assert skill.failure.reason == Reason.COMMAND_LOST


def test_a_motion_that_stops_half_way_is_blocked():
    world, context = robot()

    def hold_on(skill):
        if world.clock.now() > 1.0:
            world.stop()

    skill = carry_out(world, context, lambda skill: follow(skill, swing(world, 0.6)), each_tick=hold_on)
    assert skill.failure.reason == Reason.MOTION_BLOCKED


@pytest.mark.parametrize(("patience", "soonest"), [(0.5, 2.5), (4.0, 6.0)])
def test_it_gives_up_when_its_patience_is_over(patience, soonest):
    world, context = robot(deaf_to=JointTrajectory)
    carry_out(world, context, lambda skill: follow(skill, swing(world, 0.3), patience=patience))
    assert world.clock.now() == pytest.approx(soonest, abs=0.2)
