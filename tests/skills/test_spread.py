"""The collar is taken near a shoulder and drawn on, headward and to the neck, as far as it comes."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Estimate, GraspPoint
from caretree.skills.core.reasons import Reason
from caretree.skills.scripted.scripted_person import laid_strap, lying_posture
from caretree.skills.spread import Spread

from .bench import PATH, LeafBench, beside_bed, pulls

STAND = (0.97, -0.62, np.pi)  # beside the right shoulder, facing the bed [m, m, rad]
COLLAR = np.array((0.14, -0.50, 0.83))  # on the chest [m]
HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "cloth")
HELD = Estimate(stamp=0.0, confidence=0.9)


def bench(*, cloth=HELD, armhole=HIDDEN, collar=True, each_tick=lambda bench: None):
    """The right hand is to draw the collar at the right shoulder: what hand and head see."""
    lies = lying_posture("right")
    point = GraspPoint(
        stamp=0.0,
        confidence=0.9,
        target="collar_right",
        position_in_map=COLLAR,
        approach_in_map=np.array((0.0, 0.0, -1.0)),
        closing_in_map=np.array((0.0, 1.0, 0.0)),
    )
    return LeafBench(
        lambda context: Spread("spread", context, side="right", hand="right"),
        beside_bed(
            stand=STAND,
            arm=lies,
            relocalised_arm=lies,
            collar_near_shoulder=point if collar else HIDDEN,
            gripped_cloth=cloth,
            held_armhole=armhole,
        ),
        each_tick=each_tick,
    )


def draws(run):
    """For each time that the fingers were closed: positions (n, 3) of the hand meanwhile [m]."""
    shut = run.openings("right") < 0.005
    edges = np.flatnonzero(np.diff(np.concatenate(((False,), shut, (False,))).astype(int)))
    return [run.way("right")[a:b] for a, b in edges.reshape(-1, 2)]


def test_the_collar_is_lifted_and_drawn_to_the_neck_twice():
    run = bench()
    assert run.ended() is None
    assert len(draws(run)) == 2
    for way in draws(run):
        assert way[0] == pytest.approx(COLLAR, abs=0.03)
        drawn = way[-1] - way[0]
        assert drawn[2] == pytest.approx(0.05, abs=0.02)  # [m]
        assert np.linalg.norm(drawn[:2]) == pytest.approx(0.15, abs=0.03)  # [m]
        assert drawn[0] < -0.03, "towards the neck"
        assert drawn[1] < -0.10, "towards the head of the bed"
    assert run.openings("right")[-1] > 0.08
    assert run.way("right")[-1, 2] - draws(run)[-1][-1, 2] == pytest.approx(0.12, abs=0.03), "drawn back"


def test_a_collar_that_pulls_is_drawn_no_farther():
    def taut(bench):
        way = bench.world.observe().pose_hand_in_map[1, :3, 3] - COLLAR
        pulls(bench.world, "right", (0.0, 5.0 if way[1] < -0.06 else 0.5, 0.0))

    run = bench(each_tick=taut)
    assert run.ended() is None
    for way in draws(run):
        assert way[0, 1] - way[-1, 1] == pytest.approx(0.07, abs=0.02)  # [m] towards the head


def test_a_sleeve_that_sits_at_the_shoulder_is_drawn_no_farther():
    ring = PATH.point(-0.58) + 0.02 * np.array([(np.cos(a), np.sin(a), 0.0) for a in np.linspace(0.0, 6.0, 20)])
    run = bench(armhole=replace(laid_strap("right"), armhole_points_in_map=ring))
    assert run.ended() is None
    for way in draws(run):
        assert np.linalg.norm((way[-1] - way[0])[:2]) < 0.03  # [m]


def test_a_miss_ends_with_the_hand_open_and_clear_unless_it_has_drawn_once():
    missed = bench(cloth=HIDDEN)
    assert missed.ended() == Reason.GRASP_MISSED
    assert missed.openings("right").min() < 0.005
    assert missed.openings("right")[-1] > 0.08
    assert missed.way("right")[-1, 2] - draws(missed)[0][0, 2] == pytest.approx(0.12, abs=0.03)
    once = bench(cloth=[HELD, HIDDEN])
    assert once.ended() is None
    assert once.openings("right")[-1] > 0.08


def test_a_collar_that_does_not_show_is_told_and_no_hand_moves():
    run = bench(collar=False)
    assert run.ended() == Reason.NOTHING_SEEN
    assert run.way("right")[-1] == pytest.approx(run.start.pose_hand_in_map[1, :3, 3], abs=0.005)
