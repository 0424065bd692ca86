"""An observation that has not its form is told by the first thing that is wrong with it."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.known_robots import robot_named
from caretree.sim.observation_form import ObservationForm
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld

FORM = ObservationForm(BAXTER)


@pytest.mark.parametrize("name", ["baxter", "ur5-pair"])
def test_each_robot_has_its_own_number_of_joints(name):
    robot = robot_named(name)
    seen = ScriptedWorld(robot=robot).observe()
    assert ObservationForm(robot).fault(seen) == ""
    other = {"baxter": "ur5-pair", "ur5-pair": "baxter"}[name]
    assert "arm_positions has shape (2, " in ObservationForm(robot_named(other)).fault(seen)


@pytest.mark.parametrize("name", FORM.shapes)
def test_every_array_has_its_shape(name):
    shape = FORM.shapes[name]
    short = np.zeros((*shape[:-1], shape[-1] - 1))
    fault = FORM.fault(replace(ScriptedWorld().observe(), **{name: short}))
    assert fault == f"{name} has shape {short.shape}, but {shape} is asked for"


@pytest.mark.parametrize(
    ("field", "value", "said"),
    [
        ("arm_positions", [[0.0] * 7] * 2, "arm_positions is a list, but an array of shape (2, 7) is asked for"),
        ("gripper_force", None, "gripper_force is a NoneType, but an array of shape (2,) is asked for"),
        ("gripper_opening", np.array((85.0, 0.0)), "gripper_opening is [85.0, 0.0] m, but 0 to 0.085 m is asked for"),
        ("gripper_opening", np.array((0.05, -0.05)), "gripper_opening is [0.05, -0.05] m, but 0 to 0.085 m is asked"),
        ("gripper_opening", np.array(("wide", "open")), "gripper_opening holds what is no number"),
        ("time", None, "time is a NoneType, but a number is asked for"),
        ("head_pan", np.zeros(1), "head_pan is a ndarray of shape (1,), but a number is asked for"),
        ("emergency_stop", np.zeros(2, bool), "emergency_stop is a ndarray of shape (2,), but yes or no is asked for"),
    ],
)
def test_what_is_wrong_is_one_clause(field, value, said):
    assert FORM.fault(replace(ScriptedWorld().observe(), **{field: value})).startswith(said)


@pytest.mark.parametrize("value", [{}, None, "nothing"])
def test_what_is_no_observation_is_called_by_its_name(value):
    assert FORM.fault(value).startswith("observe gave no Observation, but ")


def test_single_numbers_of_any_kind_will_do():
    seen = replace(ScriptedWorld().observe(), head_pan=np.float32(0.1), emergency_stop=np.bool_(False), time=0)
    assert FORM.fault(seen) == ""
    assert FORM.fault(replace(seen, head_pan=np.array(0.1))) == ""
