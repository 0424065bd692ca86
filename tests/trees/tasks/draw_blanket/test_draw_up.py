"""The edge is lifted over the arm, drawn headward by the base, and laid down on the chest."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import PULLING
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.draw_blanket.draw_up import DrawUp

from ....skills.bench import CLOTH, LeafBench, beside_bed, pulls

STAND = {"right": (1.15, 0.0, np.pi), "left": (-1.15, 0.0, 0.0)}  # of the base


def bench(side="right", arm=None, each_tick=lambda bench: None):
    """The robot stands beside the thighs, the edge in the hand that is nearer to the feet."""
    hand = PULLING[side]
    return LeafBench(
        lambda context: DrawUp("draw", context, side=side, hand=hand),
        beside_bed(stand=STAND[side], held={hand: CLOTH}, arm=arm or lying_posture(side)),
        each_tick=each_tick,
    )


@pytest.mark.parametrize("side", ["right", "left"])
def test_it_goes_over_the_arm_to_the_chest_and_is_let_go_of_there(side):
    run = bench(side)
    assert run.ended() is None
    hand = PULLING[side]
    held = run.way(hand)[run.openings(hand) < 0.01]
    shoulder = lying_posture(side).points_in_map[0]
    assert held[:, 2].max() - held[0, 2] > 0.15, "lifted"  # [m]
    assert 0.15 < held[-1, 1] - shoulder[1] < 0.30, "on the chest, off the throat"  # [m]
    assert np.ptp(held[:, 0]) < 0.05, "along the bed"  # [m]
    assert np.linalg.norm(np.diff(held[:, :2], axis=0), axis=1).max() < 0.15 / 15, "slowly"  # [m] a tick
    assert run.openings(hand)[-1] > 0.03
    assert run.way(hand)[-1, 2] > held[-1, 2] + 0.1 or np.linalg.norm(run.way(hand)[-1] - held[-1]) > 0.1


def test_an_arm_that_does_not_show_is_told_and_the_edge_is_held():
    run = bench(arm=PerceptionFailure(Problem.ARM_LOST, "right arm"))
    assert run.ended() == Reason.ARM_LOST
    assert run.openings("right")[-1] < 0.01


def test_a_blanket_that_pulls_is_laid_down_where_it_is():
    def taut(bench):
        here, start = (seen.pose_hand_in_map[1, 1, 3] for seen in (bench.world.observe(), bench.start))
        pulls(bench.world, "right", (0.0, 12.0 if here < start - 0.1 else 1.0, -1.0))

    run = bench(each_tick=taut)
    assert run.ended() is None
    held = run.way("right")[run.openings("right") < 0.01]
    assert held[-1, 1] == pytest.approx(held[0, 1] - 0.1, abs=0.04)  # [m]
    assert run.openings("right")[-1] > 0.03
