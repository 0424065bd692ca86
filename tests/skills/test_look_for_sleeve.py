"""A sleeve is looked for until it shows well, and remembered; that it does not show is no failure."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.sim.world import JointTrajectory
from caretree.skills.belief.sleeve_search import SleeveMemory
from caretree.skills.core.reasons import Reason
from caretree.skills.look_for_sleeve import LookForSleeve
from caretree.skills.scripted.scripted_person import laid_strap, lying_posture

from .bench import LeafBench, beside_bed

CLEAR = laid_strap("right")
VAGUE = replace(CLEAR, confidence=0.2)
HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "sleeve")


def bench(head, hand=HIDDEN, deaf_to=()):
    """A look for the right sleeve, which shows to the cameras of head and hand like that; and the cameras as used."""
    arm = lying_posture("right")
    cameras = []

    def sleeve(frame, *, side, near_in_map):
        cameras.append(frame.camera)
        answer = head if frame.camera == "head" else hand
        if isinstance(answer, PerceptionFailure):
            raise answer
        return answer

    run = LeafBench(
        lambda context: LookForSleeve("look", context, side="right", hand="right"),
        beside_bed(deaf_to=deaf_to, sleeve_opening=sleeve, arm=arm, relocalised_arm=arm),
    )
    return run, cameras


def remembered(run):
    """Sleeves that the run remembers as seen well."""
    return run.context.memory.of(SleeveMemory, SleeveMemory).sleeves


def test_one_that_shows_well_to_the_head_is_remembered_and_no_hand_moves():
    run, cameras = bench(CLEAR)
    assert run.ended() is None
    assert cameras == ["head"]
    assert remembered(run)["right"].position_in_map == pytest.approx(CLEAR.position_in_map)
    assert np.ptp(run.way("right"), axis=0) == pytest.approx(np.zeros(3), abs=0.01)


def test_one_that_shows_badly_is_looked_at_from_above_and_the_hand_comes_back():
    better = replace(CLEAR, position_in_map=CLEAR.position_in_map + (0.03, 0.0, 0.0))
    run, cameras = bench(VAGUE, better)
    assert run.ended() is None
    assert cameras[-1] == "right_hand"
    assert set(cameras[:-1]) == {"head"}
    assert len(cameras) > 3, "the head has looked to the hand and to the elbow before"
    assert remembered(run)["right"].position_in_map == pytest.approx(better.position_in_map)
    way = run.way("right")
    above = way[np.argmin(np.linalg.norm(way - CLEAR.position_in_map, axis=1))]
    assert above[2] > CLEAR.position_in_map[2] + 0.1
    assert np.linalg.norm(way - way[0], axis=1).max() > 0.1
    assert way[-1] == pytest.approx(run.start.pose_hand_in_map[1, :3, 3], abs=0.03)


@pytest.mark.parametrize("hand", [HIDDEN, VAGUE])
def test_one_that_shows_badly_from_everywhere_is_no_failure(hand):
    run, cameras = bench(VAGUE, hand)
    assert run.ended() is None
    assert not remembered(run)
    assert cameras.count("right_hand") > 1
    assert run.way("right")[-1] == pytest.approx(run.start.pose_hand_in_map[1, :3, 3], abs=0.03)


def test_one_that_does_not_show_at_all_is_no_failure():
    run, cameras = bench(HIDDEN)
    assert run.ended() is None
    assert set(cameras) == {"head"}
    assert "does not see" in run.skill.feedback_message


def test_a_robot_that_does_not_move_is_told():
    run, _ = bench(VAGUE, deaf_to=(JointTrajectory,))
    assert run.ended() == Reason.COMMAND_LOST
