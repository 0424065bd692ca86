import numpy as np
import pytest
from caretree.skills.control.head import look_towards, pan_head

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
