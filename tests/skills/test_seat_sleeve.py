"""The armhole of a worn sleeve is taken by its front edge, drawn along the arm beyond the shoulder, and let go of."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Estimate, GraspPoint
from caretree.perception.image.cloud import unit
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import stance
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.skills.seat_sleeve import SeatSleeve

from .bench import LeafBench, beside_bed, pulls

ARM = lying_posture("right").points_in_map
PLACE = ARM[0] + 0.35 * (ARM[1] - ARM[0]) + (0.0, 0.0, 0.06)
HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "cloth")
CHEST = 0.6 + 0.22  # [m] the front of an adult
HELD = Estimate(stamp=0.0, confidence=0.9)
FRONT = GraspPoint(
    stamp=0.0,
    confidence=0.9,
    target="sleeve_right",
    position_in_map=PLACE,
    approach_in_map=np.array((0.0, 0.0, -1.0)),
    closing_in_map=np.array((1.0, 0.0, 0.0)),
)


def bench(*, cloth=HELD, front=FRONT, each_tick=lambda bench: None):
    return LeafBench(
        lambda context: SeatSleeve("seat", context, side="right", hand="right"),
        beside_bed(
            stand=stance("right", "shoulder"),
            armhole_front=front,
            gripped_cloth=cloth,
            arm=lambda frame, side, **_: lying_posture(side),
        ),
        each_tick=each_tick,
    )


def drawn(run):
    """Positions (n, 3) of the hand while its fingers were closed [m]."""
    return run.way("right")[run.openings("right") < 0.005]


def test_it_is_taken_on_top_of_the_arm_drawn_up_beside_the_shoulder_and_laid_down_there():
    run = bench()
    assert run.ended() is None
    way = drawn(run)
    assert way[0] == pytest.approx(PLACE, abs=0.03)
    assert way[np.argmax(way[:, 2])] - ARM[0] == pytest.approx((-0.05, -0.02, 0.27), abs=0.03)  # [m]
    assert (way[-1] - ARM[0])[:2] == pytest.approx((-0.05, -0.02), abs=0.03)
    assert way[:, 2].max() - way[-1, 2] > 0.05, "laid down"
    assert way[-1, 2] > CHEST, "clear of the chest"
    assert way[:, 2].min() > PLACE[2] - 0.03, "above the arm"
    assert run.openings("right")[-1] == pytest.approx(0.05, abs=0.01), "no finger comes down to the chest"
    assert run.way("right")[-1, 2] - way[-1, 2] == pytest.approx(0.12, abs=0.04), "drawn back"


def test_a_sleeve_that_pulls_back_is_drawn_no_farther():
    along = unit(ARM[1] - ARM[0])

    def taut(bench):
        here = bench.world.observe().pose_hand_in_map[1, :3, 3]
        pulls(bench.world, "right", 9.0 * along if (here - PLACE) @ along < -0.06 else 0.5 * along)

    run = bench(each_tick=taut)
    assert run.ended() is None
    assert ((drawn(run) - PLACE) @ along).min() == pytest.approx(-0.06, abs=0.02)  # [m]


def test_a_miss_ends_with_the_hand_open_and_drawn_back():
    run = bench(cloth=HIDDEN)
    assert run.ended() == Reason.GRASP_MISSED
    assert run.openings("right")[-1] > 0.08
    assert run.way("right")[-1, 2] > PLACE[2] + 0.05  # [m]


def test_an_armhole_that_does_not_show_is_told_and_no_hand_moves():
    run = bench(front=HIDDEN)
    assert run.ended() == Reason.NOTHING_SEEN
    assert run.sent == 0
