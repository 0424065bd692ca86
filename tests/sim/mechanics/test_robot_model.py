"""A robot that skills cannot plan with is refused in one sentence."""

from dataclasses import fields, replace

import numpy as np
import pytest
from caretree.sim.mechanics.kinematics import Kinematics
from caretree.sim.mechanics.robot_model import MotionLimits, RobotError, RobotModel
from caretree.sim.robot.baxter import BAXTER


def changed(**values) -> RobotModel:
    return replace(BAXTER, **values)


def test_a_robot_with_one_arm_is_refused_in_one_sentence():
    with pytest.raises(RobotError) as refused:
        changed(name="ur5", arms=("right",))
    assert str(refused.value) == "the robot ur5 has one arm, but the skills move two, left and right"


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"arms": ("a", "b")}, "the arms of baxter are a, b, but left, right is asked for"),
        ({"arm_joints": ("a", "b")}, "an arm of baxter has 2 joints"),
        ({"arm_joints": ("a",) * 7}, "six or more different ones"),
        ({"ready": np.zeros((2, 6))}, r"the posture ready of baxter has shape \(2, 6\), but \(2, 7\)"),
        ({"ready": np.full((2, 7), np.nan)}, "the posture ready of baxter holds a number that is not finite"),
        ({"capsules": ()}, "no capsule of baxter has a name that begins with left_ and holds 'finger'"),
        (
            {"capsules": tuple(c for c in BAXTER.capsules if not c.name.startswith("right_palm"))},
            "no capsule of baxter has a name that begins with right_ and holds 'palm'",
        ),
        ({"capsules": tuple(replace(c, radius=-c.radius) for c in BAXTER.capsules)}, "has a radius of -"),
        ({"capsules": tuple(replace(c, radius=1e3 * c.radius) for c in BAXTER.capsules)}, "are asked for"),
        ({"held_up": np.zeros(7)}, r"the posture held_up of baxter has shape \(7,\)"),
        ({"limits": replace(BAXTER.limits, arm_acceleration=np.ones(6))}, r"has shape \(6,\), but \(7,\)"),
        ({"limits": replace(BAXTER.limits, motion_torque=np.ones(6))}, r"motion_torque of baxter has shape \(6,\)"),
    ],
)
def test_what_does_not_fit_together_is_refused(values, said):
    with pytest.raises(RobotError, match=said):
        changed(**values)


@pytest.mark.parametrize("name", [each.name for each in fields(MotionLimits) if each.name != "sources"])
def test_every_limit_has_a_source_and_is_more_than_zero(name):
    sources = {key: text for key, text in BAXTER.limits.sources.items() if key != name}
    with pytest.raises(RobotError, match=f"{name} has no source"):
        replace(BAXTER.limits, sources=sources)
    with pytest.raises(RobotError, match="more than 0"):
        replace(BAXTER.limits, **{name: 0.0 * np.asarray(getattr(BAXTER.limits, name))})


def test_joints_are_told_by_side_and_place():
    assert BAXTER.dof == 7
    assert BAXTER.joints_of("right")[-1] == "right_w2"
    assert len(BAXTER.commanded_joints) == 15
    assert BAXTER.place_of("right_s1") == (1, 1)
    assert BAXTER.place_of(BAXTER.head_joint) is None


@pytest.mark.extra
@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"hands": {"left": "left_tcp", "right": "right_tcp"}}, "has no link 'left_tcp', which its hands name"),
        ({"own_pairs": (("left_nothing", "torso"),)}, "has no link 'left_nothing', which its own_pairs name"),
        ({"head_joint": "neck"}, "has no joint 'neck' that moves, which its head_joint name"),
        (
            {
                "urdf": lambda: BAXTER.urdf().replace(
                    'name="left_s0" type="revolute"', 'name="left_s0" type="continuous"'
                )
            },
            "the joint 'left_s0' of baxter is continuous",
        ),
    ],
)
def test_what_a_description_lacks_is_told_and_does_not_end_the_program(values, said):
    """Pinocchio takes the number behind the last link for one that there is not, and reads beyond its memory."""
    with pytest.raises(RobotError, match=said):
        Kinematics(changed(**values))
