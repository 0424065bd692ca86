"""Both armholes of worn sleeves are taken by their front edges, drawn up to the shoulders at once, and laid down."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Estimate, GraspPoint, WornSleeve
from caretree.sim.world import SIDES
from caretree.skills.control.hands import gap_between_arms
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import outwards, stance_at_head
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.skills.seat_sleeves import SeatSleeves, SeatSleevesTuning

from .bench import LeafBench, beside_bed, pulls

ARMS = {side: lying_posture(side).points_in_map for side in SIDES}
PLACES = {side: arm[0] + 0.35 * (arm[1] - arm[0]) + (0.0, 0.0, 0.06) for side, arm in ARMS.items()}
HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "cloth")
CHEST = 0.6 + 0.22  # [m] the front of an adult
LEANS = SeatSleevesTuning().leans  # [rad]
FAR_OUT = 0.22  # [m]
HELD = Estimate(stamp=0.0, confidence=0.9)


def front_of(side, farther_out=0.0):
    """Where the front edge of an armhole is seen, `farther_out` [m] than above the arm."""
    return GraspPoint(
        stamp=0.0,
        confidence=0.9,
        target=f"sleeve_{side}",
        position_in_map=PLACES[side] + farther_out * outwards(side),
        approach_in_map=np.array((0.0, 0.0, -1.0)),
        closing_in_map=np.array((1.0, 0.0, 0.0)),
    )


def worn(side, reach):
    return WornSleeve(
        stamp=0.0, confidence=0.9, side=side, armhole_at=1.0 - reach, cuff_at=0.6, reach=reach, round_arm=0.8
    )


def bench(*, cloth=HELD, hidden=(), low=SIDES, leans=LEANS, farther_out=0.0, each_tick=lambda bench: None):
    def front(frame, side, **_):
        if side in hidden:
            raise HIDDEN
        return front_of(side, farther_out)

    return LeafBench(
        lambda context: SeatSleeves("seat", context, tuning=SeatSleevesTuning(leans=leans)),
        beside_bed(
            stand=stance_at_head(),
            armhole_front=front,
            worn_sleeve=lambda frame, side, **_: worn(side, 0.5 if side in low else 0.8),
            gripped_cloth=cloth,
            arm=lambda frame, side, **_: lying_posture(side),
        ),
        each_tick=each_tick,
    )


def drawn(run, side):
    """Positions (n, 3) of a hand while the fingers of both were closed [m]."""
    both = (run.openings("left") < 0.005) & (run.openings("right") < 0.005)
    return run.way(side)[both]


def test_both_are_taken_on_top_of_the_arms_drawn_up_beside_the_shoulders_and_laid_down_there():
    run = bench()
    assert run.ended() is None
    for side, inwards in (("left", 0.12), ("right", -0.12)):  # [m] along x
        way, shoulder = drawn(run, side), ARMS[side][0]
        assert way[0] == pytest.approx(PLACES[side], abs=0.03)
        assert way[np.argmax(way[:, 2])] - shoulder == pytest.approx((inwards, 0.02, 0.27), abs=0.03)  # [m]
        assert (way[-1] - shoulder)[:2] == pytest.approx((inwards, 0.05), abs=0.03)
        assert way[:, 2].max() - way[-1, 2] > 0.05, "laid down"
        assert way[-1, 2] > CHEST, "clear of the chest"
        assert run.openings(side)[-1] == pytest.approx(0.05, abs=0.01), "no finger comes down to the chest"
        assert run.way(side)[-1, 2] - way[-1, 2] == pytest.approx(0.12, abs=0.04), "drawn back"


@pytest.mark.parametrize("lean", [0.0, 0.45])  # of the hands, outwards [rad]
def test_the_arms_stay_apart_and_upright_hands_come_less_far(lean):
    gaps = []
    run = bench(leans=(lean,), each_tick=lambda bench: gaps.append(gap_between_arms(bench.skill)))
    assert run.ended() is None
    assert min(gaps) > 0.02  # [m]
    inwards = drawn(run, "left")[:, 0].max() - ARMS["left"][0, 0]
    assert inwards == pytest.approx(0.12 if lean else 0.05, abs=0.03)


def test_fronts_far_outside_the_shoulders_are_taken_by_hands_that_lean_less():
    assert bench(leans=LEANS[:1], farther_out=FAR_OUT).ended() == Reason.UNREACHABLE
    assert bench(farther_out=FAR_OUT).ended() is None


def test_both_rise_at_the_same_time():
    run = bench()
    run.ended()
    left, right = (drawn(run, side)[:, 2] for side in SIDES)
    assert np.abs(left - right).max() < 0.03  # [m]


@pytest.mark.parametrize(("low", "high"), [SIDES, SIDES[::-1]])
def test_a_sleeve_that_is_high_enough_is_left_alone(low, high):
    run = bench(low=(low,), hidden=(high,))
    assert run.ended() is None
    assert np.ptp(run.way(high), axis=0) == pytest.approx(0.0, abs=1e-3)  # [m]
    closed = run.openings(low) < 0.005  # [m]
    assert np.ptp(run.way(low)[closed][:, 2]) > 0.1  # [m]


def test_nothing_moves_where_both_are_high_enough():
    run = bench(low=())
    assert run.ended() is None
    assert all(np.ptp(run.way(side), axis=0) == pytest.approx(0.0, abs=1e-3) for side in SIDES)


def test_a_sleeve_that_pulls_back_is_drawn_no_farther_and_the_other_one_is():
    inwards = np.array((-1.0, 0.0, 0.0))

    def taut(bench):
        here = bench.world.observe().pose_hand_in_map[1, :3, 3]
        pulls(bench.world, "right", -9.0 * inwards if (here - PLACES["right"]) @ inwards > 0.04 else -0.5 * inwards)

    run = bench(each_tick=taut)
    assert run.ended() is None
    assert ((drawn(run, "right") - PLACES["right"]) @ inwards).max() == pytest.approx(0.04, abs=0.02)  # [m]
    assert np.abs(drawn(run, "left")[:, 0] - ARMS["left"][0, 0]).max() > 0.08  # [m]


def test_a_miss_ends_with_the_hand_open_and_drawn_back():
    run = bench(cloth=HIDDEN)
    assert run.ended() == Reason.GRASP_MISSED
    assert run.openings("left")[-1] > 0.08
    assert run.way("left")[-1, 2] > PLACES["left"][2] + 0.05  # [m]


@pytest.mark.parametrize("hidden", SIDES)
def test_an_armhole_that_does_not_show_is_told_and_no_hand_moves(hidden):
    run = bench(hidden=(hidden,))
    assert run.ended() == Reason.NOTHING_SEEN
    assert all(np.ptp(run.way(side), axis=0) == pytest.approx(0.0, abs=1e-3) for side in SIDES)
