"""A seated strap is tucked down beside the shoulder, unless that pulls too hard or the mattress is near."""

import pytest
from caretree.sim.world import SIDES
from caretree.skills.geometry.stances import stance
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.skills.seat_sleeve import SeatSleeve

from .bench import GRIP, LeafBench, beside_bed


def heights(load, bed_below):
    """Heights (n,) of the hand over time, for a strap that pulls footward, and a bed that far below the hand [m]."""
    lies = lying_posture("right")
    run = LeafBench(
        lambda context: SeatSleeve("seat sleeve", context, grip=GRIP),
        beside_bed(stand=stance("right", "shoulder"), load={"right": (0.0, load, 0.0)}, arm=lies, relocalised_arm=lies),
    )
    run.world.room.bed[1, 2] = run.start.pose_hand_in_map[SIDES.index("right"), 2, 3] - bed_below
    assert run.ended(seconds=200.0) is None
    return run.way("right")[:, 2]


def test_a_strap_that_gives_goes_down():
    height = heights(load=1.0, bed_below=0.6)
    assert height[0] - height.min() == pytest.approx(0.18, abs=0.03)  # [m]: 3 s at 0.06 m/s


def test_it_stops_above_the_mattress():
    height = heights(load=1.0, bed_below=0.09)
    assert height[0] - height.min() == pytest.approx(0.05, abs=0.03)


def test_a_taut_strap_is_not_pulled_down():
    height = heights(load=6.5, bed_below=0.6)
    assert height[0] - height.min() < 0.02
