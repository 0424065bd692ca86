import numpy as np
import pytest
from caretree.sim.scripted.world import ScriptedWorld
from caretree.trees.guard.motions_under_way import MotionsUnderWay


def test_a_motion_is_under_way_until_its_time_is_over():
    world = ScriptedWorld()
    moving = MotionsUnderWay(world.clock)
    moving.arm_moves("left", 0.2, 1.0)
    moving.base_moves(np.array((0.3, 0.4, -0.1)), 2.0)
    assert (moving.arm_speed("left"), moving.arm_speed("right")) == (0.2, 0.0)
    seen = world.observe()
    reach = np.linalg.norm(seen.pose_hand_in_map[0, :2, 3] - seen.pose_base_in_map[:2])
    assert moving.carried("left", seen) == pytest.approx(0.5 + 0.1 * reach)
    world.clock.wait_until(1.5)
    assert moving.arm_speed("left") == 0.0
    assert moving.carried("left", seen) > 0.5
    world.clock.wait_until(2.5)
    assert moving.carried("left", seen) == 0.0


def test_a_stop_cuts_a_motion_short_once_and_only_one_that_has_begun():
    world = ScriptedWorld()
    moving = MotionsUnderWay(world.clock)
    moving.arm_moves("right", 0.2, 1.0)
    assert not moving.cut_short(0.0)
    moving.begin()
    assert not moving.cut_short(1.0)
    assert moving.cut_short(0.5)
    assert not moving.cut_short(0.5)
    moving.begin()
    moving.forget()
    assert not moving.cut_short(0.0)
