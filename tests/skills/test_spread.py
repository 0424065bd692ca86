"""The collar is taken by its middle, lifted, and laid down on the midline; one that lies well is left alone."""

import dataclasses

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Estimate, GraspPoint
from caretree.perception.person.person_facts import PERSON
from caretree.skills.belief.shoulders import COLLAR_SEEN
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import stance_at_head
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.skills.spread import Spread, SpreadTuning

from .bench import LeafBench, beside_bed, pulls

HEIGHT = 0.83  # of the collar on the chest [m]
HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "cloth")
HELD = Estimate(stamp=0.0, confidence=0.9)


def collar_at(aside, y):
    """The collar's middle `aside` of the midline and at `y` in the map [m]."""
    return GraspPoint(
        stamp=0.0,
        confidence=0.9,
        target="collar_middle",
        position_in_map=np.array((aside + COLLAR_SEEN.aside, y, HEIGHT)),
        approach_in_map=np.array((0.0, 0.0, -1.0)),
        closing_in_map=np.array((0.0, 1.0, 0.0)),
    )


def bench(*, aside=0.14, along=-0.53, cloth=HELD, collar=None, each_tick=lambda bench: None):
    """From the head of the bed; the collar's middle lies `aside`, on the right hand's side where it is above 0 [m]."""

    return LeafBench(
        lambda context: Spread("spread", context),
        beside_bed(
            stand=stance_at_head(),
            collar_middle=collar or collar_at(aside, along),
            gripped_cloth=cloth,
            arm=lambda frame, side, **_: lying_posture(side),
        ),
        each_tick=each_tick,
    )


def carried(run, hand="right"):
    """Positions (n, 3) of a hand while its fingers were closed [m]."""
    return run.way(hand)[run.openings(hand) < 0.005]


def test_a_collar_that_lies_aside_is_lifted_and_laid_down_at_the_midline():
    run = bench()
    assert run.ended() is None
    way = carried(run)
    assert way[0] == pytest.approx((0.14, -0.53, HEIGHT), abs=0.03), "where it was seen"
    assert way[:, 2].max() - way[0, 2] == pytest.approx(0.10, abs=0.02)  # [m]
    assert way[-1, 2] - way[0, 2] == pytest.approx(0.02, abs=0.02)
    assert way[-1, 0] - way[0, 0] == pytest.approx(-0.13, abs=0.02), "to 1 cm from the midline"
    assert run.openings("right")[-1] == pytest.approx(0.035, abs=0.005), "wide, a finger would push the chest [m]"
    assert run.way("right")[-1, 2] - way[-1, 2] == pytest.approx(0.12, abs=0.03), "drawn back"


def test_a_collar_on_the_throat_is_drawn_footward_by_one_hand():
    run = bench(aside=-0.018, along=-0.65)  # 0.10 m headward of the shoulders
    assert run.ended() is None
    way = carried(run, "left")
    assert way[-1, 1] - way[0, 1] == pytest.approx(0.15, abs=0.02), "to 5 cm footward of the shoulders"
    assert np.ptp(way[:, 0]) < 0.02  # [m]
    assert run.openings("right").min() > 0.05, "the other hand holds nothing"


def test_a_collar_a_little_headward_is_brought_as_far_beyond_the_line_as_one_on_the_throat():
    run = bench(aside=0.0, along=-0.62)  # 0.07 m headward of the shoulders
    assert run.ended() is None
    held = carried(run)
    assert held[-1, 1] - held[0, 1] == pytest.approx(0.12, abs=0.02), "5 cm beyond it [m]"


def test_it_is_carried_above_the_body():
    way = carried(bench_that_ended())
    way = way[: np.argmin(way[:, 0])]
    between = (way[:, 0] < way[0, 0] - 0.03) & (way[:, 0] > way[-1, 0] + 0.03)
    assert way[between, 2].min() > way[0, 2] + 0.07  # [m]


def test_it_goes_past_the_midline_and_is_drawn_back_along_the_body():
    way = carried(bench_that_ended())
    assert way[:, 0].min() - way[-1, 0] == pytest.approx(-SpreadTuning().beyond, abs=0.02)  # [m]
    back = way[np.argmin(way[:, 0]) :]
    assert back[back[:, 0] > way[:, 0].min() + 0.02, 2].max() < way[0, 2] + 0.04  # [m]


def bench_that_ended():
    run = bench()
    assert run.ended() is None
    return run


@pytest.mark.parametrize("aside", [-0.015, 0.015])
def test_a_collar_that_lies_well_is_left_alone(aside):
    run = bench(aside=aside)
    assert run.ended() is None
    assert run.sent == 0


def test_a_collar_of_which_too_little_shows_is_laid_anew_however_near_it_looks():
    run = bench(collar=dataclasses.replace(collar_at(0.02, -0.53), confidence=0.75))
    assert run.ended() is None
    hands = [hand for hand in ("left", "right") if len(carried(run, hand))]
    assert len(hands) == 1
    way = carried(run, hands[0])
    assert way[:, 0].min() < way[0, 0] - 0.04, "past its place, to the other side"
    assert way[-1, 0] == pytest.approx(way[0, 0] - 0.01, abs=0.015)


def test_a_collar_that_was_taken_low_at_the_flank_is_laid_down_above_the_chest():
    low = dataclasses.replace(collar_at(0.18, -0.53), position_in_map=np.array((0.18, -0.53, 0.79)))
    run = bench(collar=low)
    assert run.ended() is None
    way = carried(run)
    chest = run.world.room.bed[1, 2] + PERSON.front_height
    assert way[way[:, 0] < 0.08, 2].min() > chest + 0.005  # [m]


def test_a_collar_that_pulls_is_carried_no_farther():
    def taut(bench):
        x = bench.world.observe().pose_hand_in_map[1, 0, 3]
        pulls(bench.world, "right", (9.0 if x < 0.08 else 0.5, 0.0, 0.0))

    run = bench(each_tick=taut)
    assert run.ended() is None
    assert carried(run)[:, 0].min() == pytest.approx(0.08, abs=0.02)  # [m]


def test_a_miss_ends_with_the_hand_open_and_drawn_back():
    run = bench(cloth=HIDDEN)
    assert run.ended() == Reason.GRASP_MISSED
    assert run.openings("right").min() < 0.005
    assert run.openings("right")[-1] > 0.08
    assert run.way("right")[-1, 2] > HEIGHT + 0.05  # [m]


def test_a_collar_that_does_not_show_is_told_and_no_hand_moves():
    run = bench(collar=HIDDEN)
    assert run.ended() == Reason.NOTHING_SEEN
    assert run.way("right")[-1] == pytest.approx(run.start.pose_hand_in_map[1, :3, 3], abs=0.005)


def test_a_collar_far_aside_is_taken_by_the_cloth_on_its_way_to_the_midline_and_farther_down_where_no_hand_gets():
    asked = []

    def collar(frame, *, near_in_map, away=(0.0, 0.0)):
        asked.append(away)
        out_of_reach = 0.9 if 0.0 < away[1] < 0.06 else 0.0  # [m]
        return dataclasses.replace(seen, position_in_map=seen.position_in_map + (*away, out_of_reach))

    seen = collar_at(0.14, -0.50)
    run = bench(collar=collar)
    assert run.ended() is None
    x, y = np.transpose(asked)
    assert asked[0] == (0.0, 0.0), "first, where it lies"
    assert (x[1:3] < 0.0).all(), "towards the midline"
    assert y[1] < y[2]
    assert carried(run)[0] == pytest.approx((0.14 + x[2], -0.50 + y[2], HEIGHT), abs=0.03)


def test_a_collar_near_the_midline_is_taken_below_its_middle():
    asked = []

    def collar(frame, *, near_in_map, away=(0.0, 0.0)):
        asked.append(away)
        return dataclasses.replace(seen, position_in_map=seen.position_in_map + (*away, 0.0))

    seen = collar_at(0.06, -0.50)
    run = bench(collar=collar)
    assert run.ended() is None
    assert asked[1][0] == 0.0
    assert asked[1][1] > 0.0


def test_the_hand_on_its_way_down_stops_where_it_touches_the_body():
    def chest(bench):
        height = bench.world.observe().pose_hand_in_map[1, 2, 3]
        x = bench.world.observe().pose_hand_in_map[1, 0, 3]
        pulls(bench.world, "right", (0.0, 0.0, 5.0 if x < 0.0 and height < HEIGHT + 0.05 else -0.5))

    run = bench(each_tick=chest)
    assert run.ended() is None
    way = carried(run)
    assert way[way[:, 0] < 0.0, 2].min() > HEIGHT + 0.04  # [m]


def test_the_other_hand_takes_the_collar_where_the_near_one_does_not_get():
    def collar(frame, *, near_in_map, away=(0.0, 0.0)):
        return dataclasses.replace(
            seen, position_in_map=np.array((-0.5, -0.6, HEIGHT)) if any(away) else seen.position_in_map
        )

    seen = collar_at(0.05, -0.62)
    run = bench(collar=collar)
    assert run.ended() is None
    assert run.openings("left").min() < 0.005  # [m]
    assert run.openings("right").min() > 0.03  # [m]
