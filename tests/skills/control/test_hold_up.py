import numpy as np
import pytest
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import SIDES
from caretree.skills.control.hold_up import plan_turn, present, presented, presenting, turned_by
from caretree.skills.core.reasons import Reason
from caretree.skills.motion.errors import MotionBlocked

from ..moving import carry_out, idle, robot


@pytest.mark.parametrize("side", SIDES)
def test_a_hand_that_is_held_up_points_down_and_turns_where_it_is(side):
    kinematics = kinematics_of(BAXTER)
    first = kinematics.pose_hand_in_base(side, presented(BAXTER, side, 0.0))
    assert first[2, 2] < -0.98
    assert 1.2 < first[2, 3] < 1.5
    for angle in (-2.0, -0.4, 0.9, 2.4):
        pose = kinematics.pose_hand_in_base(side, presented(BAXTER, side, angle))
        np.testing.assert_allclose(pose[:3, 3], first[:3, 3], atol=2e-3)
        c, s = np.cos(angle), np.sin(angle)
        np.testing.assert_allclose(pose[:2, 0], ((c, -s), (s, c)) @ first[:2, 0], atol=0.02)
        assert turned_by(BAXTER, side, presented(BAXTER, side, angle)) == pytest.approx(angle, abs=0.02)


def test_both_sides_are_mirror_images():
    kinematics = kinematics_of(BAXTER)
    left, right = (kinematics.pose_hand_in_base(side, presented(BAXTER, side, 0.0))[:3, 3] for side in SIDES)
    np.testing.assert_allclose(left, right * (1.0, -1.0, 1.0), atol=2e-3)


def test_an_arm_elsewhere_is_not_held_up():
    assert turned_by(BAXTER, "right", model.READY[1]) is None
    _, context = robot()
    with pytest.raises(MotionBlocked, match="not held up"):
        plan_turn(idle(context), "right", 0.5)


def test_too_far_a_turn_is_refused_in_degrees():
    with pytest.raises(ValueError, match=r"150 degrees.*200"):
        presented(BAXTER, "left", np.deg2rad(200.0))


def test_the_other_arm_is_ready():
    np.testing.assert_allclose(presenting(BAXTER, "right", 0.3)[0], model.READY[0])


def test_a_hand_is_brought_up_and_then_turned_without_leaving_its_place():
    world, context = robot()
    assert carry_out(world, context, lambda skill: present(skill, "right", 0.0)).failure is None
    assert turned_by(BAXTER, "right", world.observe().arm_positions[1]) == pytest.approx(0.0, abs=0.05)
    seen = []
    skill = carry_out(
        world,
        context,
        lambda skill: present(skill, "right", 1.0),
        each_tick=lambda skill: seen.append(world.observe().pose_hand_in_map[1, :3, 3]),
    )
    assert skill.failure is None
    assert turned_by(BAXTER, "right", world.observe().arm_positions[1]) == pytest.approx(1.0, abs=0.05)
    assert np.ptp(np.array(seen), axis=0).max() < 0.04


def test_what_is_in_the_way_is_told():
    world, context = robot(base=(0.9, 0.0, np.pi))
    world.room.bed[1, 2] = 1.4  # a bed as high as the hand
    skill = carry_out(world, context, lambda skill: present(skill, "right", 0.0))
    assert skill.failure.reason in (Reason.MOTION_BLOCKED, Reason.UNREACHABLE)
