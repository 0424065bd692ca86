from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Estimate
from caretree.sim.world import SIDES
from caretree.skills.control.hands import hand_now
from caretree.skills.control.pinch import back_off, grasp_poses, holds_cloth, pinch, reach_in
from caretree.skills.core.reasons import Reason

from ..moving import angle_between, carry_out, idle, robot

AHEAD, SIDEWAYS = np.array((1.0, 0.0, 0.0)), np.array((0.0, 1.0, 0.0))
CLOTH = {"left": np.array((3.4, -2.2, 1.1)), "right": np.array((3.4, -2.8, 1.1))}  # before a robot at (2.5, -2.5)


def seen(confidence):
    return Estimate(stamp=0.0, confidence=confidence)


@pytest.mark.parametrize("side", SIDES)
def test_the_hand_waits_before_the_cloth_and_goes_straight_in(side):
    _, context = robot()
    before, inside = grasp_poses(idle(context), side, CLOTH[side], AHEAD, SIDEWAYS, standoff=0.1, depth=0.02)
    np.testing.assert_allclose(before[:3, 3], CLOTH[side] - 0.1 * AHEAD, atol=1e-9)
    np.testing.assert_allclose(inside[:3, 3], CLOTH[side] + 0.02 * AHEAD, atol=1e-9)
    np.testing.assert_allclose(before[:3, :3], inside[:3, :3])
    assert angle_between(inside[:3, 2], AHEAD) < 1e-6
    assert abs(inside[:3, 1] @ SIDEWAYS) > 0.8, "the fingers close as they should, or nearly"


def test_cloth_out_of_reach_is_told():
    world, context = robot()
    skill = carry_out(world, context, lambda skill: reach_in(skill, "left", CLOTH["left"] + 2.0, AHEAD, SIDEWAYS))
    assert skill.failure.reason == Reason.UNREACHABLE


def test_open_fingers_come_around_the_cloth_slower_in_the_end():
    world, context = robot()
    track = []

    def watch(skill):
        track.append((hand_now(skill, "right")[:3, 3], world.observe().gripper_opening[1]))

    skill = carry_out(
        world,
        context,
        lambda skill: reach_in(skill, "right", CLOTH["right"], AHEAD, SIDEWAYS, opening=0.05, speed=0.3),
        each_tick=watch,
    )
    assert skill.failure is None
    hand = hand_now(skill, "right")[:3, 3]
    assert 0.0 < hand[0] - CLOTH["right"][0] < 0.04, "the cloth is between the fingers"
    np.testing.assert_allclose(hand[1:], CLOTH["right"][1:], atol=0.01)
    path, openings = np.array([position for position, _ in track]), np.array([opening for _, opening in track])
    near = np.flatnonzero(np.linalg.norm(path[:-1] - hand, axis=1) < 0.1)
    speed = np.linalg.norm(np.diff(path, axis=0), axis=1) * 15
    assert openings[near].min() == pytest.approx(0.05, abs=1e-3)
    assert speed[near].max() < 0.17
    assert speed.max() > 0.2


def test_a_hand_that_meets_somebody_on_its_way_in_goes_no_farther():
    world, context = robot()
    met, observe = CLOTH["right"][0] - 0.05, world.observe

    def touching():
        seen = observe()
        wrench = np.array(seen.wrench_hand_in_map)
        wrench[1, 0] -= 1000.0 * max(0.0, seen.pose_hand_in_map[1, 0, 3] - met)  # [N], as stiff as a body
        return replace(seen, wrench_hand_in_map=wrench)

    world.observe = touching
    skill = carry_out(world, context, lambda skill: reach_in(skill, "right", CLOTH["right"], AHEAD, SIDEWAYS))
    assert skill.failure is None
    assert met < hand_now(skill, "right")[0, 3] < met + 0.03


@pytest.mark.parametrize(
    ("sight", "reason"),
    [
        (seen(0.9), None),
        (seen(0.02), Reason.GRASP_MISSED),
        (PerceptionFailure(Problem.NOTHING_SEEN, "cloth"), Reason.GRASP_MISSED),
    ],
)
def test_the_hands_camera_tells_whether_cloth_was_taken(sight, reason):
    world, context = robot(gripped_cloth=sight)
    skill = carry_out(world, context, lambda skill: pinch(skill, "left"))
    assert (skill.failure.reason if skill.failure else None) == reason
    assert world.observe().gripper_opening[0] < 0.005


@pytest.mark.parametrize(("problem", "confidence"), [(Problem.HIDDEN, 0.8), (Problem.NOTHING_SEEN, 0.0)])
def test_where_cloth_hides_the_fingertips_the_heads_camera_is_asked(problem, confidence):
    def sight(frame, pose_hand_in_map):
        if frame.camera != "head":
            raise PerceptionFailure(problem, "fingertips")
        return seen(0.8)

    _, context = robot(gripped_cloth=sight)
    assert holds_cloth(idle(context), "left") == confidence


def test_confidence_in_a_grasp_is_that_of_the_camera():
    _, context = robot(gripped_cloth=seen(0.7))
    assert holds_cloth(idle(context), "left") == 0.7


def test_backing_off_is_the_way_it_came():
    world, context = robot()
    start = hand_now(idle(context), "left")
    skill = carry_out(world, context, lambda skill: back_off(skill, "left", 0.08))
    assert skill.failure is None
    end = hand_now(skill, "left")
    np.testing.assert_allclose(end[:3, 3], start[:3, 3] - 0.08 * start[:3, 2], atol=0.005)
    np.testing.assert_allclose(end[:3, :3], start[:3, :3], atol=0.01)
