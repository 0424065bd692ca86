"""A sleeve is held open before the hand; one that does not open is carried out once more, then given up as folded."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import SleeveHeading
from caretree.skills.belief.short_gown import short_gown
from caretree.skills.core.reasons import Reason
from caretree.skills.present_sleeve import PresentSleeve
from caretree.skills.scripted.scripted_person import laid_strap, lying_arm, lying_posture

from .bench import GRIP, LeafBench, beside_bed, pulls

WRIST, FINGERTIP = lying_arm("right")[2:]
ALONG = (FINGERTIP - WRIST) * (1.0, 1.0, 0.0) / np.linalg.norm((FINGERTIP - WRIST)[:2])  # the right hand


ASIDE = np.cross((0.0, 0.0, 1.0), ALONG)  # counter-clockwise from the hand's direction


def heading(beyond, aside=0.0):
    way = beyond * ALONG + aside * ASIDE
    return SleeveHeading(stamp=0.0, confidence=0.9, side="right", cuff_from_armhole_in_map=way)


def turned(run):
    """By how much the hand has turned the strap in the end, counter-clockwise from above [rad]."""
    across = run.poses("right")[-1, :3, :3] @ GRIP.across_in_hand
    return np.arctan2(-across @ ASIDE, -across @ ALONG)


def ran(seen, load=1.0, armhole_shows=(), each_tick=lambda bench: None):
    """The bench after a run, why it failed, None after a success, and how often it looked at the sleeve.

    A heading that is None does not show; `armhole_shows` to these cameras.
    """
    looks, arm = [], lying_posture("right")

    def answer(frame, **details):
        looks.append(frame.stamp)
        if (told := seen[min(len(looks), len(seen)) - 1]) is None:
            raise PerceptionFailure(Problem.NOTHING_SEEN, "both bindings")
        return told

    def armhole(frame, **details):
        if frame.camera not in armhole_shows:
            raise PerceptionFailure(Problem.NOTHING_SEEN, "held armhole")
        return laid_strap("right", frame.stamp)

    run = LeafBench(
        lambda context: PresentSleeve("present", context, grip=GRIP, max_load=4.0, min_cuff_distance=0.05),
        beside_bed(
            load={"right": (0.0, 0.0, -load)},  # the sleeve that hangs from it [N]
            arm=arm,
            relocalised_arm=arm,
            sleeve_heading=answer,
            held_armhole=armhole,
        ),
        each_tick=each_tick,
    )
    return run, run.ended(seconds=200.0), len(looks)


def test_it_comes_from_beyond_the_fingertips_and_waits_before_them_the_armhole_towards_them():
    run, reason, _ = ran([heading(0.09)])
    assert reason is None
    way = run.way("right") - FINGERTIP
    assert (way @ ALONG).max() > 0.28  # [m] out beyond the fingertips
    assert way[-1] @ ALONG == pytest.approx(0.10, abs=0.02)
    assert way[-1, 2] == pytest.approx(0.09, abs=0.02)
    near = np.linalg.norm(way - (way @ ALONG)[:, None] * ALONG, axis=1) < 0.15
    assert (way @ ALONG)[near].min() > 0.05, "it is never over the arm"
    across = run.poses("right")[-1, :3, :3] @ GRIP.across_in_hand  # from the armhole to the gown's upper edge
    assert across @ ALONG < -0.9


def test_one_that_hangs_no_more_has_slipped():
    _, reason, asked = ran([heading(0.09)], load=0.05)  # [N]
    assert (reason, asked) == (Reason.CLOTH_SLIPPED, 0)


@pytest.mark.parametrize(
    ("seen", "reason", "asked"),
    [
        ([heading(0.09)], None, 1),
        ([heading(-0.02), heading(0.08)], None, 2),
        ([heading(-0.02), heading(0.03)], Reason.SLEEVE_FOLDED, 2),
    ],
)
def test_it_is_brought_twice_at_most(seen, reason, asked):
    assert ran(seen)[1:] == (reason, asked)


@pytest.mark.parametrize("degrees", [110.0, 60.0, -70.0])
def test_one_that_points_elsewhere_is_turned_back_by_as_much(degrees):
    angle = np.deg2rad(degrees)
    run, reason, asked = ran([heading(0.09 * np.cos(angle), 0.09 * np.sin(angle)), heading(0.10)])
    assert (reason, asked) == (None, 2)
    assert turned(run) == pytest.approx(-angle, abs=0.45 * abs(angle))  # all of it, or as far as the wrist turns


def test_one_that_still_points_elsewhere_is_turned_on():
    run, reason, asked = ran([heading(0.0, 0.12), heading(0.02, -0.08), heading(0.09)])
    assert (reason, asked) == (None, 3)
    assert abs(turned(run)) < np.deg2rad(30.0)  # there and back


def test_one_that_keeps_pointing_elsewhere_is_given_up():
    assert ran([heading(0.0, 0.12)])[1:] == (Reason.SLEEVE_FOLDED, 3)


@pytest.mark.parametrize("camera", ["head", "right_hand"])
def test_one_whose_cuff_may_be_hidden_by_its_open_armhole_is_not_folded(camera):
    assert ran([None], armhole_shows=(camera,))[1:] == (None, 2)  # looks, the second one at the hand


def test_one_of_which_nothing_shows_is_folded():
    assert ran([None], armhole_shows=("left_hand",))[1] == Reason.SLEEVE_FOLDED


@pytest.mark.parametrize("load", [5.0, 7.0])
def test_a_gown_that_is_caught_is_not_torn_off(load):
    run, reason, _ = ran([heading(0.09)], load=load)  # [N]
    assert reason == Reason.SLEEVE_CAUGHT
    assert short_gown(run.skill) == {"right"}, "whose arm is spread less next time"


def test_one_that_stops_short_of_its_place_is_caught_although_it_pulls_less_once_it_stands():
    before = [np.zeros(3)]

    def taut(bench):
        here = bench.world.observe().pose_hand_in_map[1, :3, 3]
        moves = np.linalg.norm(here - before[0]) > 1e-3  # [m]
        pulls(bench.world, "right", (0.0, 0.0, -5.0 if moves and (here - FINGERTIP) @ ALONG > 0.2 else -3.0))
        before[0] = here

    run, reason, _ = ran([heading(0.09)], each_tick=taut)
    assert reason == Reason.SLEEVE_CAUGHT
    assert short_gown(run.skill) == {"right"}
