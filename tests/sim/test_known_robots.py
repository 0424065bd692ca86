"""Robots are found by name, and what is none is refused in one sentence."""

import pytest
from caretree.sim.known_robots import ROBOTS, robot_named
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.mechanics.robot_model import RobotError
from caretree.sim.world import CAMERAS, SIDES


@pytest.mark.parametrize("name", ROBOTS)
def test_each_known_robot_stands_with_its_hands_before_it(name):
    robot = robot_named(name)
    assert robot.name == name
    assert set(robot.cameras) == set(CAMERAS)
    for n, side in enumerate(SIDES):
        limits = kinematics_of(robot).limits[side]
        for posture in (robot.ready, robot.held_up):
            assert limits.margin(posture[n]) > 0.04
        hand = kinematics_of(robot).pose_hand_in_base(side, robot.ready[n])
        assert hand[0, 3] > 0.4
        assert (hand[1, 3] > 0.0) == (side == "left")
        up = kinematics_of(robot).pose_hand_in_base(side, robot.held_up[n])
        assert up[2, 2] < -0.95
        assert up[2, 3] > 1.1


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("atlas", "unknown robot 'atlas'; there are baxter, ur5-pair"),
        ("no_such_module:ROBOT", "robot no_such_module:ROBOT cannot be loaded"),
        ("caretree.sim.robot.baxter:MIRROR", "has no RobotModel MIRROR"),
        ("caretree.sim.robot.baxter:NOTHING", "has no RobotModel NOTHING"),
    ],
)
def test_what_is_no_robot_is_refused(name, said):
    with pytest.raises(RobotError, match=said):
        robot_named(name)
