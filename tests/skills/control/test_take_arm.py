"""A hand comes to an arm from above, and knows whether it has it."""

import numpy as np
import pytest
from caretree.skills.control.arm_grip import over_arm
from caretree.skills.control.take_arm import take_arm
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import stance
from caretree.skills.scripted.scripted_person import lying_posture

from ..moving import carry_out, robot

ON_ARM = over_arm(lying_posture("right"), 1.0, lift=0.0)


def takes(between, met_at=-np.inf, finger=0.0, on_arm=ON_ARM):
    """World, guard, the skill that took the right elbow with the left hand, and the hand's way (n, 3).

    Something `met_at` [m] above the map's floor pushes the hand up with 20 N.  A `finger` 42 mm off the hand's middle,
    on that side of it, is pushed so while the hand is more than 5 mm to the other side of the arm.
    """
    world, context = robot(base=tuple(stance("right", "lift")))
    world.between_fingers["left"] = between
    way = []

    def felt(skill):
        pose = skill.world.observe().pose_hand_in_map[0]
        way.append(pose[:3, 3])
        beside = not finger or finger * pose[:3, 1] @ (ON_ARM[:3, 3] - pose[:3, 3]) > 0.005
        push = np.array((0.0, 0.0, 20.0 if way[-1][2] < met_at and beside else 0.0))
        world.load["left"] = np.append(push, np.cross(0.042 * finger * pose[:3, 1], push))

    skill = carry_out(world, context, lambda skill: take_arm(skill, "left", on_arm), each_tick=felt)
    return world, context.guard, skill, np.array(way)


def test_it_goes_over_the_arm_and_straight_down_around_it():
    world, guard, skill, way = takes(0.07)
    assert skill.failure is None
    assert way[-1] == pytest.approx(ON_ARM[:3, 3] - (0.0, 0.0, 0.005), abs=0.01)
    near = np.linalg.norm(way[:, :2] - ON_ARM[:2, 3], axis=1) < 0.02
    assert np.ptp(way[near][:, 2]) == pytest.approx(0.125, abs=0.02)
    assert guard.grip("left") == "arm"
    assert world.observe().gripper_opening[0] == pytest.approx(0.07, abs=0.003)


def test_a_hand_that_closes_on_nothing_opens_above_the_arm():
    world, guard, skill, way = takes(0.0)
    assert skill.failure.reason == Reason.GRASP_MISSED
    assert way[-1] == pytest.approx(ON_ARM[:3, 3] + (0.0, 0.0, 0.12), abs=0.01)
    assert world.observe().gripper_opening[0] > 0.08
    assert guard.grip("left") == "nothing"


def test_a_hand_that_comes_down_on_something_else_goes_up_again_before_it_closes():
    met_at = ON_ARM[2, 3] + 0.05
    world, guard, skill, way = takes(0.07, met_at)
    assert skill.failure.reason == Reason.GRASP_MISSED
    assert way[:, 2].min() > met_at - 0.03
    assert way[-1] == pytest.approx(ON_ARM[:3, 3] + (0.0, 0.0, 0.12), abs=0.01)
    assert world.observe().gripper_opening[0] > 0.08
    assert guard.grip("left") == "nothing"


@pytest.mark.parametrize("finger", [1.0, -1.0])
def test_a_hand_that_comes_down_beside_the_arms_middle_feels_on_which_side_it_is(finger):
    beside = ON_ARM.copy()
    beside[:3, 3] -= finger * 0.012 * ON_ARM[:3, 1]
    _, guard, skill, way = takes(0.07, ON_ARM[2, 3] + 0.035, finger, beside)
    assert skill.failure is None
    assert guard.grip("left") == "arm"
    assert abs(ON_ARM[:3, 1] @ (way[-1] - ON_ARM[:3, 3])) < 0.005


def test_a_hand_that_finds_no_arm_to_either_side_gives_up():
    far = ON_ARM.copy()
    far[:3, 3] -= 0.04 * ON_ARM[:3, 1]
    _, guard, skill, way = takes(0.07, ON_ARM[2, 3] + 0.035, 1.0, far)
    assert skill.failure.reason == Reason.GRASP_MISSED
    low = way[way[:, 2] < far[2, 3] + 0.05]
    assert np.ptp((low - far[:3, 3]) @ ON_ARM[:3, 1]) < 0.025
    assert guard.grip("left") == "nothing"


@pytest.mark.parametrize("aside", [0.005, -0.005])
def test_a_hand_goes_to_the_side_of_the_finger_that_meets_a_stiff_arm_first(aside):
    """An arm of 5 N/mm whose middle is `aside` [m] of the hand's, once the fingers begin to close."""
    world, context = robot(base=tuple(stance("right", "lift")))
    world.between_fingers["left"] = 0.07
    pushes = []

    def felt(skill):
        pose = skill.world.observe().pose_hand_in_map[0]
        off = aside - (pose[:3, 3] - ON_ARM[:3, 3]) @ pose[:3, 1]
        closes = skill.world.observe().gripper_opening[0] < 0.083
        world.load["left"] = np.append(closes * 5e3 * off * pose[:3, 1], np.zeros(3))
        pushes.append(closes * 5e3 * abs(off))

    skill = carry_out(world, context, lambda skill: take_arm(skill, "left", ON_ARM), each_tick=felt)
    assert skill.failure is None
    assert max(pushes) > 23.0  # [N] at first
    assert pushes[-1] < 15.0
