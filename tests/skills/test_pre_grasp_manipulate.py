"""One end of the neckline is isolated and taken by the free hand while the other hand holds the gown up."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Estimate, LayerCount, PreGrasp
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.baxter import BAXTER
from caretree.skills.control.hold_up import presenting
from caretree.skills.core.reasons import Reason
from caretree.skills.pre_grasp_manipulate import PreGraspManipulate
from caretree.skills.view_around import Views

from .hung_gown import AHEAD, DOWN, LEFT, STAND, at, bench_with, ended

ARMS = presenting(BAXTER, "right", 0.0)
HELD = kinematics_of(BAXTER).pose_hand_in_map("right", ARMS[1], STAND)
GOOD, POOR = at(0.75, 0.10, 1.05), at(0.75, 0.14, 0.90)  # two ends of the neckline below the holding hand
SIDEWAYS = -0.05 * LEFT  # of a sweep [m]
BACK = 0.08  # [m] from the corner, at least, of a hand that has drawn back


def pre_grasp(corner, *, primitive="direct", sweep=None, confidence=0.9):
    sweep = np.zeros(3) if sweep is None else sweep
    return PreGrasp(
        stamp=0.0,
        confidence=confidence,
        view=0,
        primitive=primitive,
        corner_in_map=corner,
        position_in_map=corner - sweep,
        approach_in_map=AHEAD,
        sweep_in_map=sweep,
    )


def best_left(*candidates):
    """Senses that show the first candidate that is not excluded, as the ones from images do."""

    def answer(frames, *, poses_hand_in_map, distance, exclude=()):
        held = poses_hand_in_map[0]
        tried = [held[:3, 3] + held[:3, :3] @ place for place in exclude]
        for candidate in candidates:
            if all(np.linalg.norm(candidate.corner_in_map - place) > 0.03 for place in tried):
                return candidate
        return PerceptionFailure(Problem.NOTHING_SEEN, "an end of the neckline")

    return answer


def layers(count):
    """Senses that count `count(pose (4, 4) of the hand)` sheets between the fingers."""

    def answer(frames, *, side, pose_hand_in_map, **details):
        return LayerCount(stamp=0.0, confidence=0.9, side=side, layers=count(pose_hand_in_map))

    return answer


def bench(shown, *, sheets=lambda pose: 1, tug=lambda place: 0.5, **ports):
    """The right hand holds the gown; `tug(place)` is what pulls at the left hand where it closed [N]."""

    def make(context):
        frame = context.world.look("head")
        views = Views(hand="right", frames=(frame,), poses_hand_in_map=(HELD,))
        return PreGraspManipulate("take", context, views=views, **ports)

    made = bench_with(
        make, arms=ARMS, pre_grasp=shown, layers=layers(sheets), gripped_cloth=Estimate(stamp=0.0, confidence=0.9)
    )
    made.grasps = []
    send = made.world.send

    def pull(side, hand):
        closed = made.world.closed.get("left")
        return tug(closed[0]) * DOWN if side == "left" and closed else np.zeros(3)

    def noted(command):
        before = made.world.closed.get("left")
        sent = send(command)
        if (now := made.world.closed.get("left")) is not before:
            made.grasps.append(now[0])
        return sent

    made.world.pull, made.world.send = pull, noted
    return made


def test_takes_the_best_end_with_the_free_hand():
    run = bench(best_left(pre_grasp(GOOD), pre_grasp(POOR)))
    assert ended(run) is None
    assert len(run.grasps) == 1
    assert np.linalg.norm(run.grasps[0] - GOOD) < 0.02  # [m]
    assert (run.skill.holder, run.skill.former) == ("left", "right")
    assert run.skill.corner.corner_in_map == pytest.approx(GOOD)


def test_sweeps_before_it_closes():
    run = bench(best_left(pre_grasp(GOOD, primitive="move_right", sweep=SIDEWAYS)))
    ways = []
    assert ended(run, each_tick=lambda: ways.append(run.world.hand("left")[:3, 3])) is None
    assert np.linalg.norm(run.grasps[0] - GOOD) < 0.02  # [m]
    before = GOOD - SIDEWAYS
    assert min(np.linalg.norm(place - before) for place in ways) < 0.025  # [m]: it went in aside of the corner


def test_approaches_so_that_one_sheet_is_between_the_fingers():
    def sheets(pose):
        return 1 if pose[:3, 2] @ DOWN > np.sin(np.deg2rad(40.0)) else 2

    run = bench(best_left(pre_grasp(GOOD)), sheets=sheets)
    assert ended(run) is None
    assert len(run.grasps) == 1
    assert run.skill.corner.approach_in_map @ DOWN > np.sin(np.deg2rad(40.0))


def test_several_sheets_are_not_taken():
    run = bench(best_left(pre_grasp(GOOD)), sheets=lambda pose: 2)
    assert ended(run, seconds=120.0) == Reason.MULTI_LAYER
    assert not run.grasps


def test_an_end_that_was_missed_twice_is_left_out_for_the_next_best():
    run = bench(
        best_left(pre_grasp(GOOD), pre_grasp(POOR)), tug=lambda place: 0.0 if place[2] > GOOD[2] - 0.07 else 0.5
    )
    assert ended(run, seconds=120.0) is None
    assert [float(np.round(place[2], 1)) for place in run.grasps] == [1.0, 1.0, 0.9]
    assert run.skill.corner.corner_in_map == pytest.approx(POOR)


def test_a_hand_that_took_nothing_is_open_and_drawn_back():
    run = bench(best_left(pre_grasp(GOOD)), tug=lambda place: 0.0)
    assert ended(run, seconds=120.0) == Reason.GRASP_MISSED
    assert run.world.observe().gripper_opening[0] > 0.08  # [m]
    assert np.linalg.norm(run.world.hand("left")[:3, 3] - GOOD) > BACK


def test_a_doubtful_end_is_not_gone_for():
    run = bench(best_left(pre_grasp(GOOD, confidence=0.1)))
    assert ended(run) == Reason.NOTHING_SEEN
    assert run.sent == 0
