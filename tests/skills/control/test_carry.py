"""Cloth is carried straight, and no farther than it comes along."""

import numpy as np
import pytest
from caretree.skills.control.carry import Carry, carry
from caretree.skills.core.skill import Skill

from ..bench import LeafBench, beside_bed, pulls

STAND = (0.80, -0.62, np.pi)  # beside the right shoulder, facing the bed [m, m, rad]


class Lift(Skill):
    """Carries the right hand 10 cm up."""

    def steps(self):
        here = self.world.observe().pose_hand_in_map[1, :3, 3]
        yield from carry(self, "right", here + (0.0, 0.0, 0.10), Carry())


def lifted(each_tick=lambda bench: None):
    run = LeafBench(lambda context: Lift("lift", context), beside_bed(stand=STAND), each_tick=each_tick)
    assert run.ended() is None
    way = run.way("right")
    return way[-1] - way[0]


def test_it_goes_straight_to_its_goal():
    assert lifted() == pytest.approx((0.0, 0.0, 0.10), abs=0.012)


def test_a_load_against_the_way_ends_it_and_one_along_it_does_not():
    assert lifted(lambda bench: pulls(bench.world, "right", (0.0, 0.0, -9.0)))[2] < 0.02  # [m]
    assert lifted(lambda bench: pulls(bench.world, "right", (9.0, 0.0, 0.5)))[2] > 0.08


def test_a_hand_that_touches_the_body_stops():
    assert lifted(lambda bench: pulls(bench.world, "right", (0.0, 0.0, 4.0)))[2] < 0.02  # [m]
