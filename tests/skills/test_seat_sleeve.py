"""A seated strap is drawn headward, and tucked down beside the shoulder as far as it goes."""

from dataclasses import replace

import pytest
from caretree.sim.world import SIDES
from caretree.skills.geometry.stances import HEADWARD, stance
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.skills.seat_sleeve import SeatSleeve

from .bench import CLOTH, GRIP, LeafBench, beside_bed


def ran(load, bed_below, beyond=0.0):
    """The bench after a run, for a strap that pulls footward with `load` [N], and a bed that far below the hand [m].

    The hand begins `beyond` [m] headward of the shoulder.
    """
    lies = lying_posture("right")
    start = beside_bed(stand=stance("right", "shoulder"))()[0].observe().pose_hand_in_map[SIDES.index("right"), :3, 3]
    aside = (start - beyond * HEADWARD - lies.points_in_map[0]) * (0.0, 1.0, 0.0)
    lies = replace(lies, points_in_map=lies.points_in_map + aside)
    run = LeafBench(
        lambda context: SeatSleeve("seat sleeve", context, grip=GRIP),
        beside_bed(
            stand=stance("right", "shoulder"),
            held={"right": CLOTH},
            load={"right": (0.0, load, 0.0)},
            arm=lies,
            relocalised_arm=lies,
        ),
    )
    run.world.room.bed[1, 2] = run.start.pose_hand_in_map[SIDES.index("right"), 2, 3] - bed_below
    assert run.ended(seconds=200.0) is None
    return run


def heights(load, bed_below):
    """Heights (n,) of the hand over time [m]."""
    return ran(load, bed_below).way("right")[:, 2]


@pytest.mark.parametrize(("load", "drawn"), [(0.4, 0.08), (5.0, 0.0)])
def test_a_strap_that_gives_is_drawn_headward(load, drawn):
    way = ran(load, bed_below=0.6).way("right")
    assert way[0, 1] - way[:, 1].min() == pytest.approx(drawn, abs=0.02)  # [m]; the head of the bed is at lower y


@pytest.mark.parametrize(("beyond", "drawn"), [(0.04, 0.04), (0.15, 0.0)])
def test_a_strap_is_not_drawn_over_the_face(beyond, drawn):
    way = ran(0.4, bed_below=0.6, beyond=beyond).way("right")
    assert way[0, 1] - way[:, 1].min() == pytest.approx(drawn, abs=0.02)  # [m]


@pytest.mark.parametrize("load", [0.4, 3.0])
def test_a_strap_is_neither_slackened_nor_let_go_of_in_the_end(load):
    run = ran(load, bed_below=0.6)
    way = run.way("right")
    assert way[-1, 1] == pytest.approx(way[:, 1].min(), abs=0.005)  # [m]
    assert run.openings("right").max() < 0.01


def test_a_strap_that_gives_goes_down():
    height = heights(load=1.0, bed_below=0.6)
    assert height[0] - height.min() == pytest.approx(0.18, abs=0.03)  # [m]: 3 s at 0.06 m/s


def test_it_stops_above_the_mattress():
    height = heights(load=1.0, bed_below=0.09)
    assert height[0] - height.min() == pytest.approx(0.05, abs=0.03)


def test_a_taut_strap_is_not_pulled_down():
    height = heights(load=6.5, bed_below=0.6)
    assert height[0] - height.min() < 0.02
