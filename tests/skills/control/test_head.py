import numpy as np
import pytest
from caretree.sim.world import JointTrajectory
from caretree.skills.control.head import arm_gaps, keep_off_the_arms, look_towards, pan_head

from ..moving import carry_out, robot


@pytest.mark.parametrize("bearing", [-0.6, 0.4])
def test_the_head_turns_to_a_point(bearing):
    world, context = robot(base=(2.5, -2.5, 1.0))
    far = np.array((2.5, -2.5)) + 50.0 * np.array((np.cos(1.0 + bearing), np.sin(1.0 + bearing)))
    skill = carry_out(world, context, lambda skill: look_towards(skill, far))
    assert skill.failure is None
    assert world.observe().head_pan == pytest.approx(bearing, abs=0.01)


def test_the_neck_turns_as_far_as_it_can():
    world, context = robot()
    assert carry_out(world, context, lambda skill: pan_head(skill, 9.0)).failure is None
    assert 1.0 < world.observe().head_pan < 2.0


def test_a_head_that_looks_there_already_is_not_moved():
    world, context = robot()
    carry_out(world, context, lambda skill: pan_head(skill, 0.01))
    assert not world.sent


def with_raised_arm(pan):
    """World and context of a robot whose right elbow is beside its head, which looks at `pan` [rad] (132)."""
    world, context = robot(base=(0.0, 0.0, 0.0))
    raised = np.array((0.03, -1.81, 0.27, 1.69, 0.31, 1.71, 3.05, pan))
    joints = (*world.robot.joints_of("right"), world.robot.head_joint)
    here = np.append(world.observe().arm_positions[1], 0.0)
    world.send(JointTrajectory(joints=joints, times=np.array((0.0, 3.0)), positions=np.stack((here, raised))))
    world.clock.wait_until(4.0)
    return world, context


def test_it_looks_beside_a_point_where_an_arm_would_be_at_the_head():
    world, context = with_raised_arm(0.0)
    point = far_at(-0.55)
    assert carry_out(world, context, lambda skill: look_towards(skill, point)).failure is None
    assert -0.5 < world.observe().head_pan <= -0.19


def test_it_turns_away_from_an_arm_that_comes_near_but_not_from_what_it_looks_at():
    world, context = with_raised_arm(-0.55)
    gaps = []

    def watch(skill):
        for _ in range(60):
            gaps.append(arm_gaps(skill)(world.observe(), world.observe().head_pan))
            keep_off_the_arms(skill, far_at(-0.7))
            yield

    assert carry_out(world, context, watch).failure is None
    assert gaps[0] < 0.015
    assert gaps[-1] > gaps[0] + 0.02
    assert world.observe().head_pan < -0.7 + 0.61


def far_at(bearing):
    return 50.0 * np.array((np.cos(bearing), np.sin(bearing)))
