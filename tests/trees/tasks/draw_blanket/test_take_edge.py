"""The edge is taken from above, near the robot, and felt by its weight."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import GraspPoint
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import LIFTING
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.draw_blanket.take_edge import TakeEdge

from ....skills.bench import LeafBench, beside_bed, pulls

EDGE = np.array((0.22, 0.25, 0.70))  # on the right [m]
STAND = {"right": (1.25, 0.0, np.pi), "left": (-1.25, 0.0, 0.0)}  # of the base
OUT = {"right": 1.0, "left": -1.0}


def bench(side="right", weight=1.5, seen=None):
    hand = LIFTING[side]
    edge = EDGE * (OUT[side], 1.0, 1.0)

    def hangs(bench):
        closed = bench.world.observe().gripper_opening[0 if hand == "left" else 1] < 0.005
        pulls(bench.world, hand, (0.0, 0.0, -weight if closed else 0.0))

    shown = GraspPoint(
        stamp=0.0,
        confidence=0.9,
        target="near_hang",
        position_in_map=edge,
        approach_in_map=np.array((0.0, 0.0, -1.0)),
        closing_in_map=np.array((0.0, 1.0, 0.0)),
    )
    make = lambda context: TakeEdge("take", context, side=side, hand=hand)  # noqa: E731 one line
    return LeafBench(
        make, beside_bed(stand=STAND[side], hang_point=seen or shown, arm=lying_posture(side)), each_tick=hangs
    )


@pytest.mark.parametrize("side", ["right", "left"])
def test_it_is_taken_from_above_just_inside_the_edge_and_lifted(side):
    run = bench(side)
    assert run.ended() is None
    hand = LIFTING[side]
    held = run.way(hand)[run.openings(hand) < 0.005]
    assert held[0] == pytest.approx(EDGE * (OUT[side], 1.0, 1.0) + (0.0, run.skill.inset, 0.0), abs=0.03)
    assert 0.0 < run.skill.inset < 0.2
    assert held[-1, 2] - held[0, 2] == pytest.approx(0.10, abs=0.02)
    assert run.poses(hand)[np.argmax(run.openings(hand) < 0.005), 2, 2] < -0.85, "from above"


def test_fingers_on_which_nothing_hangs_open_and_draw_back():
    run = bench(weight=0.1)
    assert run.ended() == Reason.GRASP_MISSED
    assert run.openings("left")[-1] > 0.05


def test_an_edge_that_does_not_show_is_told():
    run = bench(seen=PerceptionFailure(Problem.NOTHING_SEEN, "edge"))
    assert run.ended() == Reason.NOTHING_SEEN
    assert run.openings("left").min() > 0.05
