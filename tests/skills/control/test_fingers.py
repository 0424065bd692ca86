from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.world import SIDES, GripperOpening
from caretree.skills.control.fingers import close_gripper, let_cloth_go, open_gripper
from caretree.skills.core.reasons import Reason

from ..moving import carry_out, robot


def test_closing_tells_what_is_between_the_fingers():
    world, context = robot()
    world.between_fingers["left"] = 0.05
    assert carry_out(world, context, lambda skill: close_gripper(skill, "left")).result == pytest.approx(0.05, abs=1e-3)
    skill = carry_out(world, context, lambda skill: close_gripper(skill, "right"))
    assert skill.result == pytest.approx(0.0, abs=1e-3)
    skill = carry_out(world, context, lambda skill: open_gripper(skill, "right", 0.06))
    assert skill.failure is None
    assert world.observe().gripper_opening[1] == pytest.approx(0.06, abs=0.005)


def test_cloth_is_let_go_of_with_little_room_and_open_fingers_stay_as_they_are():
    world, context = robot()
    world._opening[:] = world._opening_goal[:] = (0.0, 0.07)
    for side, opening in (("left", 0.035), ("right", 0.07)):
        carry_out(world, context, lambda skill, side=side: let_cloth_go(skill, side))
        assert world.observe().gripper_opening[SIDES.index(side)] == pytest.approx(opening, abs=0.005)


def test_fingers_that_close_slowly_take_their_time_until_they_meet_something():
    world, context = robot()
    world.between_fingers["left"] = 0.05
    gaps = []
    carry_out(world, context, lambda skill: open_gripper(skill, "left", 0.09))
    skill = carry_out(
        world,
        context,
        lambda skill: close_gripper(skill, "left", speed=0.03),
        each_tick=lambda skill: gaps.append(float(world.observe().gripper_opening[0])),
    )
    assert skill.result == pytest.approx(0.05, abs=1e-3)
    assert -np.diff(gaps).min() * 15 < 0.04  # [m/s]
    assert world._opening_goal[0] == 0.0, "they squeeze in the end"


@pytest.mark.parametrize("motion", [close_gripper, open_gripper])
def test_fingers_that_do_not_obey_are_told(motion):
    world, context = robot(deaf_to=GripperOpening)
    world._opening[:] = world._opening_goal[:] = 0.04
    assert carry_out(world, context, lambda skill: motion(skill, "left")).failure.reason == Reason.COMMAND_LOST


def test_fingers_that_something_keeps_open_have_missed_it():
    world, context = robot(deaf_to=GripperOpening)
    world._opening[:] = world._opening_goal[:] = 0.04
    observe = world.observe
    world.observe = lambda: replace(observe(), gripper_force=np.array((25.0, 0.0)))
    failure = carry_out(world, context, lambda skill: close_gripper(skill, "left")).failure
    assert failure.reason == Reason.GRASP_MISSED
    assert "keeps the left fingers open with 25 N" in failure.detail
