from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.person.arm_fit import turned_about_shoulder
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.skills.control.arm_grip import holds_arm, lost_arm, over_arm, top_down_reachable
from caretree.skills.control.fingers import close_gripper
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.arm_path import ArmPath
from caretree.skills.geometry.stances import stance
from caretree.skills.motion.errors import Unreachable
from caretree.skills.motion.ik import solve_ik
from caretree.skills.scripted.scripted_person import lying_posture

from ..moving import carry_out, idle, robot

POSTURE = lying_posture("right")


@pytest.mark.parametrize("coordinate", [0.4, 1.0, 1.7])
def test_the_hand_comes_square_to_the_arm_from_above_and_closes_across_it(coordinate):
    pose, path = over_arm(POSTURE, coordinate, lift=0.1), ArmPath.of(POSTURE)
    np.testing.assert_allclose(pose[:3, 3], path.point(coordinate) - 0.1 * pose[:3, 2])
    assert pose[2, 2] < -0.98, "the arm lies almost flat"
    assert abs(pose[:3, 1] @ path.direction(coordinate)) < 1e-9
    assert abs(pose[:3, 2] @ path.direction(coordinate)) < 1e-9


def test_over_an_arm_that_rises_the_hand_leans_with_it():
    points = turned_about_shoulder(POSTURE.points_in_map, 1.0, POSTURE.points_in_map[1] + (0.0, 0.0, 0.2))
    raised = replace(POSTURE, points_in_map=points)
    pose = over_arm(raised, 1.4, lift=0.0)
    assert abs(pose[:3, 2] @ ArmPath.of(raised).direction(1.4)) < 1e-9
    assert pose[2, 2] < -0.7, "from above all the same"


def test_of_two_turns_one_that_the_arm_can_take_is_chosen():
    _, context = robot(base=tuple(stance("right", "lift")))
    pose = over_arm(POSTURE, 1.0, lift=0.12)
    chosen = top_down_reachable(idle(context), "left", pose)
    np.testing.assert_allclose(chosen[:3, 3], pose[:3, 3])
    assert abs(chosen[:3, 1] @ pose[:3, 1]) == pytest.approx(1.0), "the same, or turned by half a turn"
    solve_ik(kinematics_of(BAXTER), "left", chosen, stance("right", "lift"), model.READY[0])


def test_where_no_turn_leads_it_is_told():
    _, context = robot(base=tuple(stance("right", "lift")))
    with pytest.raises(Unreachable):
        top_down_reachable(idle(context), "left", over_arm(POSTURE, 1.0, lift=0.12), (np.array((-2.0, 0.0, 0.0)),))


@pytest.mark.parametrize(("thickness", "lost"), [(0.07, False), (0.05, False), (0.03, True), (0.0, True)])
def test_fingers_that_closed_on_nothing_have_lost_the_arm(thickness, lost):
    world, context = robot()
    world.between_fingers["left"] = thickness
    skill = carry_out(world, context, lambda skill: close_gripper(skill, "left", force=25.0))
    assert skill.failure is None or skill.failure.reason == Reason.GRASP_MISSED
    assert lost_arm(skill, "left") is lost
    assert holds_arm(skill, "left") is not lost


def test_an_open_hand_holds_no_arm():
    assert not holds_arm(idle(robot()[1]), "left")
