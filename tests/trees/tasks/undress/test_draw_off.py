"""The seam is drawn along above the arm and past the hand by the base, then in over the bed, and laid down."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.sim.scene.scene import BED_HALF, BED_TOP
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import LIFTING
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.undress.draw_off import DrawOff

from ....skills.bench import CLOTH, LeafBench, beside_bed, pulls

STAND = {"right": (1.25, -0.3, np.pi), "left": (-1.25, -0.3, 0.0)}  # of the base


def bench(side="right", arm=None, beyond=0.2, weight=1.5, each_tick=None):
    """The robot stands beside the shoulder, the seam in the hand that is nearer to the head."""
    hand = LIFTING[side]
    return LeafBench(
        lambda context: DrawOff("draw", context, side=side, hand=hand, beyond=beyond),
        beside_bed(stand=STAND[side], held={hand: CLOTH}, arm=arm or lying_posture(side)),
        each_tick=each_tick or (lambda bench: pulls(bench.world, hand, (0.0, 0.0, -weight))),
    )


def held(run, hand):
    """Positions (n, 3) of a hand while its fingers were closed [m]."""
    return run.way(hand)[run.openings(hand) < 0.01]


@pytest.mark.parametrize("side", ["right", "left"])
def test_it_goes_along_the_arm_past_the_hand_and_is_laid_on_the_bed(side):
    run = bench(side)
    assert run.ended() is None
    way, arm = held(run, LIFTING[side]), lying_posture(side).points_in_map
    for joint in arm[1:]:
        assert np.linalg.norm((way - joint)[:, :2], axis=1).min() < 0.06, "over every joint [m]"
    along = (arm[3] - arm[2]) / np.linalg.norm(arm[3] - arm[2])
    assert ((way - arm[3]) @ along).max() > 0.2, "the armhole lags behind the seam [m]"
    assert np.linalg.norm(np.diff(way[:, :2], axis=0), axis=1).max() < 0.15 / 15, "slowly"  # [m] a tick
    assert abs(way[-1, 0]) < BED_HALF[0] - 0.05, "on the bed [m]"
    assert 0.05 < way[-1, 2] - BED_TOP < 0.25
    assert run.openings(LIFTING[side])[-1] > 0.03


def test_the_last_one_is_drawn_as_far_as_is_asked_for():
    ends = [held(run, "left")[-1, 1] for run in (bench(beyond=0.2), bench(beyond=0.45)) if run.ended() is None]
    assert ends[1] - ends[0] == pytest.approx(0.25, abs=0.05)


def test_a_sleeve_that_pulls_hard_is_caught_and_is_drawn_no_farther():
    def taut(bench):
        here, start = (seen.pose_hand_in_map[0, 1, 3] for seen in (bench.world.observe(), bench.start))
        pulls(bench.world, "left", (0.0, -12.0 if here > start + 0.2 else -1.0, -1.0))

    run = bench(each_tick=taut)
    assert run.ended() == Reason.SLEEVE_CAUGHT
    way = held(run, "left")
    assert way[-1, 1] == pytest.approx(way[0, 1] + 0.2, abs=0.06)  # [m]


def test_a_seam_that_was_lost_is_told_and_nothing_is_claimed():
    assert bench(weight=0.0).ended() == Reason.CLOTH_SLIPPED


def test_an_arm_that_does_not_show_is_told_and_the_seam_is_held():
    run = bench(arm=PerceptionFailure(Problem.ARM_LOST, "right arm"))
    assert run.ended() == Reason.ARM_LOST
    assert run.openings("left")[-1] < 0.01
