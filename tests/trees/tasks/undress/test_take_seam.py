"""The seam over a shoulder is taken from above beside the bed, and felt by its weight."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Estimate, GraspPoint
from caretree.sim.world import SIDES
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import HEADWARD, LIFTING, outwards
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.undress.take_seam import TakeSeam

from ....skills.bench import LeafBench, beside_bed, pulls

STAND = {"right": (1.25, -0.25, np.pi), "left": (-1.25, -0.25, 0.0)}  # of the base
asked = {}


def seam_of(side):
    """Beside and headward of the shoulder (3,) [m]."""
    return lying_posture(side).points_in_map[0] + 0.13 * outwards(side) + 0.05 * HEADWARD + (0.0, 0.0, 0.05)


def bench(side="right", weight=1.5, seen=None, cloth=0.9):
    hand = LIFTING[side]

    def hangs(bench):
        closed = bench.world.observe().gripper_opening[SIDES.index(hand)] < 0.005
        pulls(bench.world, hand, (0.0, 0.0, -weight if closed else 0.0))

    def seam(frame, **details):
        asked.update(details)
        return seen or GraspPoint(
            stamp=0.0,
            confidence=0.9,
            target=f"sleeve_{side}",
            position_in_map=seam_of(side),
            approach_in_map=np.array((0.0, 0.0, -1.0)),
            closing_in_map=np.array((0.0, 1.0, 0.0)),
        )

    return LeafBench(
        lambda context: TakeSeam("take", context, side=side, hand=hand),
        beside_bed(
            stand=STAND[side],
            shoulder_seam=seam,
            arm=lying_posture(side),
            gripped_cloth=Estimate(stamp=0.0, confidence=cloth),
        ),
        each_tick=hangs,
    )


@pytest.mark.parametrize("side", ["right", "left"])
def test_it_is_taken_from_above_and_lifted(side):
    run = bench(side)
    assert run.ended() is None
    hand = LIFTING[side]
    held = run.way(hand)[run.openings(hand) < 0.005]
    assert held[0] == pytest.approx(seam_of(side), abs=0.04)
    assert held[-1, 2] - held[0, 2] == pytest.approx(0.12, abs=0.03)
    assert run.poses(hand)[np.argmax(run.openings(hand) < 0.005), 2, 2] < -0.8, "from above"
    left, right = asked["shoulders_in_map"]
    assert left[0] < right[0], "which way is outwards"


@pytest.mark.parametrize("details", [{"weight": 0.0}, {"cloth": 0.0}])
def test_a_miss_ends_with_the_hand_open_and_drawn_back(details):
    run = bench(**details)
    assert run.ended() == Reason.GRASP_MISSED
    assert run.openings("left")[-1] > 0.04
    assert run.way("left")[-1, 2] > seam_of("right")[2] + 0.05


def test_a_seam_that_does_not_show_is_told():
    run = bench(seen=PerceptionFailure(Problem.NOTHING_SEEN, "seam"))
    assert run.ended() == Reason.NOTHING_SEEN
