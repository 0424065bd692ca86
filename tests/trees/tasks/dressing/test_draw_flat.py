"""A worn gown's front is taken above the thigh next to the robot, lifted, and drawn footward and outwards."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Estimate, GraspPoint
from caretree.sim.world import SIDES
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import PULLING, stance
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.dressing.draw_flat import FLAT, DrawFlat, DrawFlatTuning

from ....skills.bench import LeafBench, beside_bed

MIDDLE = np.mean([lying_posture(side).points_in_map[0] for side in SIDES], axis=0)  # of the shoulders [m]
HEIGHT = 0.83  # of the gown over the legs [m]
HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "cloth")
HELD = Estimate(stamp=0.0, confidence=0.9)


def bench(side, *, hem=0.9, high=0.9, cloth=HELD, tuning=FLAT):
    """Beside the bed on a side; the gown reaches down to `hem` [m], and is out of reach from `high` [m] on."""

    def collar(frame, *, near_in_map, away=(0.0, 0.0)):
        if away[1] > hem:
            raise HIDDEN
        return GraspPoint(
            stamp=0.0,
            confidence=0.9,
            target="collar_middle",
            position_in_map=np.append(MIDDLE[:2] + (0.03, -0.05) + np.asarray(away), HEIGHT + 2.0 * (away[1] > high)),
            approach_in_map=np.array((0.0, 0.0, -1.0)),
            closing_in_map=np.array((0.0, 1.0, 0.0)),
        )

    return LeafBench(
        lambda context: DrawFlat("draw flat", context, side=side, hand=PULLING[side], tuning=tuning),
        beside_bed(
            stand=stance(side, "shoulder"),
            collar_middle=collar,
            gripped_cloth=cloth,
            arm=lambda frame, side, **_: lying_posture(side),
        ),
    )


@pytest.mark.parametrize(("side", "outwards"), [("left", -1.0), ("right", 1.0)])
def test_it_is_drawn_outwards_and_a_little_footward(side, outwards):
    run = bench(side)
    hand = PULLING[side]
    assert run.ended() is None
    path = run.way(hand)[run.openings(hand) < 0.005]
    assert path[0, :2] == pytest.approx(MIDDLE[:2] + (outwards * 0.20, 0.80), abs=0.03), "taken above the thigh"
    assert path[:, 2].max() - path[0, 2] == pytest.approx(0.08, abs=0.02), "above the body"
    assert path[-1] - path[0] == pytest.approx((outwards * 0.20, 0.05, 0.02), abs=0.03), "and laid down"
    assert run.openings(hand)[-1] > 0.03
    assert run.way(hand)[-1, 2] > path[-1, 2] + 0.08, "drawn back"


@pytest.mark.parametrize(
    ("gown", "taken"), [({"hem": 0.75}, 0.65), ({"hem": 0.60}, 0.50), ({"high": 0.75}, 0.65)], ids=str
)
def test_a_front_that_is_folded_up_or_out_of_reach_is_taken_elsewhere(gown, taken):
    run = bench("left", **gown)
    assert run.ended() is None
    path = run.way(PULLING["left"])[run.openings(PULLING["left"]) < 0.005]
    assert path[0, 1] == pytest.approx(MIDDLE[1] + taken, abs=0.03)
    assert path[-1, 1] - path[0, 1] == pytest.approx(0.05, abs=0.03)


def test_a_front_that_does_not_show_is_left_alone():
    run = bench("left", hem=0.4)
    assert run.ended() == Reason.NOTHING_SEEN
    assert run.openings(PULLING["left"]).min() > 0.03


def test_a_hand_that_closed_on_nothing_opens_again_and_takes_it_at_the_next_place_once():
    run = bench("left", cloth=HIDDEN)
    assert run.ended() == Reason.GRASP_MISSED
    assert run.seen[-1].gripper_opening.min() > 0.03
    assert taken_at(run) == pytest.approx([0.80, 0.65], abs=0.03)

    run = bench("left", cloth=[HIDDEN, HELD])
    assert run.ended() is None
    assert taken_at(run) == pytest.approx([0.80, 0.65], abs=0.03)


def test_one_that_was_missed_at_the_only_place_is_left():
    run = bench("left", cloth=HIDDEN, tuning=DrawFlatTuning(places=((0.20, 0.65),)))
    assert run.ended() == Reason.GRASP_MISSED
    assert len(taken_at(run)) == 1


def taken_at(run):
    """How far footward of the shoulders the fingers closed, each time [m]."""
    hand = PULLING["left"]
    shut = run.openings(hand) < 0.005
    first = shut & ~np.roll(shut, 1)
    return list(run.way(hand)[first][:, 1] - MIDDLE[1])
