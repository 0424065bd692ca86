"""The towel's end comes down behind the person's hand, and the other end is drawn back across it."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.arm_path import ArmPath
from caretree.skills.geometry.stances import PULLING
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.hand_towel.lay_on_hand import LayOnHand

from ....skills.bench import CLOTH, LeafBench, beside_bed

STAND = {"right": (1.25, -0.25, np.pi), "left": (-1.25, -0.25, 0.0)}  # of the base


def bench(side="right", load=None):
    """The robot stands beside that arm, a towel in the hand that is nearer to the feet."""
    hand = PULLING[side]
    return LeafBench(
        lambda context: LayOnHand("lay", context, side=side, hand=hand),
        beside_bed(stand=STAND[side], held={hand: CLOTH}, load=load, arm=lying_posture(side)),
    )


@pytest.mark.parametrize("arm", ["right", "left"])
def test_it_is_drawn_across_the_hand_and_let_go_of_beyond_it(arm):
    run = bench(arm)
    assert run.ended() is None
    path, hand = ArmPath.of(lying_posture(arm)), PULLING[arm]
    way, opening = run.way(hand) - path.point(2.5), run.openings(hand)
    out = 1.0 if arm == "right" else -1.0  # x of the robot's side of the bed
    held = way[opening < 0.01]
    low = held[held[:, 2] < 0.3]
    assert out * low[0, 0] < -0.1 < 0.02 < out * low[-1, 0]  # [m]
    assert low[-1, 2] < 0.1
    along = path.hand_direction[:2] / np.linalg.norm(path.hand_direction[:2])
    assert np.abs(low[:, :2] @ along).max() < 0.03  # square to the hand [m]
    assert opening[-1] > 0.07
    assert way[-1, 2] > low[-1, 2] + 0.02


def test_a_towel_that_pulls_is_carried_no_farther():
    free, caught = bench(), bench(load={"right": (-7.0, 0.0, -3.0)})
    assert (free.ended(), caught.ended()) == (None, None)
    lowest = [run.way("right")[run.openings("right") < 0.01][:, 2].min() for run in (free, caught)]
    assert lowest[1] > lowest[0] + 0.05  # [m]: it was pulled down and inwards, and lets go where it is


def test_an_arm_that_does_not_show_is_told():
    run = LeafBench(
        lambda context: LayOnHand("lay", context, side="right", hand="right"),
        beside_bed(held={"right": CLOTH}, arm=PerceptionFailure(Problem.ARM_LOST, "right arm")),
    )
    assert run.ended() == Reason.ARM_LOST
    assert run.openings("right")[-1] < 0.01, "the hand still holds the towel"
