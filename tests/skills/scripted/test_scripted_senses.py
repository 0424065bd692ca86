"""The scripted gown goes with the robot, the person stays in bed."""

import inspect

import numpy as np
import pytest
from caretree.perception.senses import Senses
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import BaseVelocity
from caretree.skills.scripted.scripted_senses import ScriptedSenses

DETAILS = {
    "side": "right",
    "before": ScriptedWorld().look("head"),
    "hook_in_map": np.zeros(3),
    "near_in_map": np.zeros(3),
    "pose_hand_in_map": np.eye(4),
    "poses_hand_in_map": [np.eye(4)],
    "poses_cloth_in_map": [np.eye(4)],
    "opening": 0.08,
    "distance": (0.1, 1.0),
    "arm_in_map": np.zeros((4, 3)),
    "points_in_map": np.zeros((5, 3)),
    "shoulders_in_map": np.zeros(3),
    "shoulder_in_map": np.zeros(3),
}


@pytest.mark.parametrize("name", sorted(Senses.__abstractmethods__))
def test_every_answer_bears_the_stamp_of_its_picture(name):
    world = ScriptedWorld()
    world.clock.wait_until(2.5)
    method, frame = getattr(ScriptedSenses(world), name), world.look("head")
    asked = [each for each in inspect.signature(method).parameters.values() if each.default is each.empty]
    details = {each.name: DETAILS[each.name] for each in asked if each.kind == each.KEYWORD_ONLY}
    found = method([frame] if asked[0].name == "frames" else frame, **details)
    assert found.stamp == 2.5
    assert found.confidence > 0.5


def test_the_hung_gown_is_before_the_robot_wherever_it_stands():
    world = ScriptedWorld()
    senses = ScriptedSenses(world)

    def in_base():
        x, y, yaw = world.observe().pose_base_in_map
        away = senses.hook(world.look("head")).position_in_map[:2] - (x, y)
        return np.array((np.cos(yaw) * away[0] + np.sin(yaw) * away[1], np.cos(yaw) * away[1] - np.sin(yaw) * away[0]))

    before = in_base()
    assert before[0] > 0.5
    world.send(BaseVelocity(velocity=np.array((0.2, 0.0, 0.5)), duration=1.0))
    world.clock.wait_until(1.0)
    assert in_base() == pytest.approx(before, abs=0.02)


def test_left_and_right_are_mirrored():
    world = ScriptedWorld()
    senses, frame = ScriptedSenses(world), world.look("head")
    left, right = (senses.arm(frame, side=side).points_in_map for side in ("left", "right"))
    np.testing.assert_allclose(left, right * (-1.0, 1.0, 1.0))
    corners = [senses.hung_corner(frame, side=side, hook_in_map=np.zeros(3)) for side in ("left", "right")]
    assert [corner.target for corner in corners] == ["collar_corner_left", "collar_corner_right"]


def test_a_person_who_moves_is_elsewhere_and_has_shifted_once():
    world = ScriptedWorld()
    senses, frame = ScriptedSenses(world), world.look("head")
    lies = senses.arm(frame, side="right").points_in_map
    assert senses.arm_shift(frame, before=frame, arm_in_map=lies).share == 0.0
    world.fault_move_person()
    assert senses.arm(frame, side="right").points_in_map - lies == pytest.approx(np.tile((0.1, 0.0, 0.0), (4, 1)))
    assert senses.arm_shift(frame, before=frame, arm_in_map=lies).share == 1.0
    assert senses.arm_shift(frame, before=frame, arm_in_map=lies).share == 0.0


def test_the_collar_is_drawn_over_to_the_middle_of_whoever_has_moved():
    world = ScriptedWorld()
    senses = ScriptedSenses(world)

    def across(**where):
        return senses.collar_middle(world.look("head"), near_in_map=np.zeros(3), **where).position_in_map[0]

    assert across() == pytest.approx(0.04)
    across(away=(0.0, 0.3))
    assert across() == 0.0
    world.fault_move_person()
    assert across() == 0.0, "it lies where it lay"
    across(away=(0.0, 0.3))
    assert across() == pytest.approx(0.1)
