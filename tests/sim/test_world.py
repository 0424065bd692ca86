"""Commands that no robot can carry out cannot be made, so that no skill's slip passes the guard."""

import numpy as np
import pytest
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import BaseVelocity, GripperOpening, HandTwist, JointTrajectory, WorldError

STILL = np.zeros(6)


def trajectory(joints=("left_s0", "head_pan"), times=(0.0, 1.0), positions=((0.0, 0.0), (0.1, 0.2))):
    return JointTrajectory(joints=joints, times=np.array(times), positions=np.array(positions))


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: HandTwist(side="middle", twist_in_map=STILL), "side is 'middle', but left or right"),
        (lambda: HandTwist(side="left", twist_in_map=np.full(6, np.nan)), "a twist holds a number that is not finite"),
        (lambda: HandTwist(side="left", twist_in_map=np.zeros(3)), r"a twist has shape \(3,\), but \(6,\)"),
        (lambda: HandTwist(side="left", twist_in_map=STILL, duration=-0.1), "duration is -0.1 s, but 0 or more"),
        (lambda: HandTwist(side="left", twist_in_map=STILL, duration=np.inf), "duration is inf s"),
        (lambda: BaseVelocity(velocity=np.array((0.0, np.inf, 0.0))), "velocity holds a number that is not finite"),
        (lambda: BaseVelocity(velocity=np.zeros(2)), r"velocity has shape \(2,\), but \(3,\)"),
        (lambda: BaseVelocity(velocity=np.zeros(3), duration=np.nan), "duration is nan s"),
        (lambda: GripperOpening(side="both", opening=0.0), "side is 'both'"),
        (
            lambda: GripperOpening(side="left", opening=np.nan),
            r"opening \[m\] of the left gripper is nan, but 0 or more",
        ),
        (lambda: GripperOpening(side="left", opening=-0.01), "opening .* is -0.01"),
        (
            lambda: GripperOpening(side="left", opening=0.0, force_limit=np.inf),
            r"force limit \[N\] of the left gripper",
        ),
        (lambda: trajectory(joints=()), "a trajectory moves nothing"),
        (lambda: trajectory(joints=("left_s0", "left_s0")), "moves left_s0, left_s0, but different joints"),
        (lambda: trajectory(times=(0.0, -1.0)), "but two and more that begin at 0 and grow"),
        (lambda: trajectory(times=(0.5, 1.0)), "but two and more that begin at 0 and grow"),
        (lambda: trajectory(times=(0.0, 0.0)), "but two and more that begin at 0 and grow"),
        (lambda: trajectory(times=(0.0,), positions=((0.0, 0.0),)), "but two and more that begin at 0 and grow"),
        (lambda: trajectory(times=(0.0, 1.0, 2.0)), r"positions of a trajectory has shape \(2, 2\), but \(3, 2\)"),
        (lambda: trajectory(positions=((0.0, 0.0), (0.1, np.nan))), "positions of a trajectory holds a number"),
    ],
)
def test_an_impossible_command_is_refused_in_one_sentence(make, said):
    with pytest.raises(WorldError, match=said) as error:
        make()
    assert "\n" not in str(error.value)


def test_possible_commands_are_made():
    assert trajectory().joints == ("left_s0", "head_pan")
    assert HandTwist(side="right", twist_in_map=STILL, duration=0.0).duration == 0.0
    assert GripperOpening(side="left", opening=0.085, force_limit=0.0).opening == 0.085


def test_a_joint_that_the_robot_does_not_have_is_refused():
    trajectory().check_joints(BAXTER)
    with pytest.raises(WorldError, match="no joint 'left_wrist'; it has head_pan and left_ or right_ with s0, s1"):
        trajectory(joints=("head_pan", "left_wrist")).check_joints(BAXTER)
