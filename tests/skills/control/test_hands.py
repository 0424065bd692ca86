import numpy as np
import pytest
from caretree.sim.robot import model
from caretree.sim.world import SIDES
from caretree.skills.control.hands import hand_now, move_arms, move_hands, until_load
from caretree.skills.core.reasons import Reason

from ..moving import carry_out, idle, robot


def test_hands_go_straight_to_their_poses():
    world, context = robot()
    start = {side: hand_now(idle(context), side) for side in SIDES}
    goals = {side: pose.copy() for side, pose in start.items()}
    for pose in goals.values():
        pose[:3, 3] += (0.05, 0.02, 0.12)
    seen = []
    skill = carry_out(
        world,
        context,
        lambda skill: move_hands(skill, goals, speed=0.2),
        each_tick=lambda skill: seen.append(hand_now(skill, "left")[:3, 3]),
    )
    assert skill.failure is None
    way = goals["left"][:3, 3] - start["left"][:3, 3]
    for position in seen:
        along = (position - start["left"][:3, 3]) @ way / (way @ way)
        assert np.linalg.norm(position - start["left"][:3, 3] - along * way) < 0.004
    for side in SIDES:
        np.testing.assert_allclose(hand_now(skill, side), goals[side], atol=0.01)
    steps = np.linalg.norm(np.diff(seen, axis=0), axis=1) * 15
    assert steps.max() < 0.22


def test_out_of_reach_is_told_before_anything_moves():
    world, context = robot()
    pose = hand_now(idle(context), "left")
    pose[:3, 3] += (3.0, 0.0, 0.0)
    skill = carry_out(world, context, lambda skill: move_hands(skill, {"left": pose}, way="either"))
    assert skill.failure.reason == Reason.UNREACHABLE
    assert not world.sent


def test_arms_go_to_joint_angles_and_the_other_one_stays():
    world, context = robot()
    skill = carry_out(world, context, lambda skill: move_arms(skill, 0.8 * model.READY, sides=("right",)))
    assert skill.failure is None
    np.testing.assert_allclose(world.observe().arm_positions, (model.READY[0], 0.8 * model.READY[1]), atol=0.01)


def test_a_motion_ends_where_the_cloth_pulls_too_hard():
    world, context = robot()
    start = hand_now(idle(context), "right")
    goal = start.copy()
    goal[2, 3] += 0.3

    def pull(skill):
        world.load["right"] = np.array((0.0, 0.0, -40.0 * (hand_now(skill, "right")[2, 3] - start[2, 3]), 0, 0, 0))

    skill = carry_out(
        world,
        context,
        lambda skill: until_load(skill, "right", 4.0, move_hands(skill, {"right": goal}, speed=0.1)),
        each_tick=pull,
    )
    assert skill.failure is None
    assert hand_now(skill, "right")[2, 3] - start[2, 3] == pytest.approx(0.1, abs=0.03), "4 N at 40 N/m"
    assert np.abs(world.observe().arm_velocities).max() < 0.02, "it stands, for the guard"
