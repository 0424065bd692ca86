"""The corner in one hand is drawn aside and up about the hook, as far as the hook bears it."""

import numpy as np
import pytest
from caretree.skills.core.reasons import Reason
from caretree.skills.raise_corner import RaiseCorner

from .hung_gown import DOWN, at, bench_with, ended, hand_from_base, holding, seen_at

AHEAD, UP = 0.75, 1.35  # of the hook, from the middle of the base [m]
HOOK = at(AHEAD, 0.0, UP)
LENGTH = 0.40  # of the strip from the hook to the hand [m]: 0.24 m aside, 0.32 m down
ARMS = holding(right=HOOK + (0.0, -0.24, -0.32))


def bench(weight, **ports):
    """The right hand has the corner; `weight` gives its load by the height above the hook [N], [m]."""
    return bench_with(
        lambda context: RaiseCorner("raise", context, hand="right", hook=seen_at(HOOK), **ports),
        arms=ARMS,
        pull=lambda side, hand: weight(hand[2] - HOOK[2]) * DOWN,
    )


def test_ends_aside_of_the_hook_and_above_it():
    run = bench(lambda height: 1.2)
    assert ended(run) is None
    ahead, left, up = hand_from_base(run.world, "right") - (AHEAD, 0.0, UP)
    assert up == pytest.approx(0.16, abs=0.01)  # [m]
    assert left < -0.25  # [m]: to the hand's own side
    assert ahead == pytest.approx(-left * np.tan(np.deg2rad(30.0)), abs=0.02)  # [m]: and behind the rail
    assert run.skill.held_length == pytest.approx(LENGTH, abs=0.005)


def test_the_strip_is_never_stretched():
    run = bench(lambda height: 1.2)
    way = []
    assert ended(run, each_tick=lambda: way.append(hand_from_base(run.world, "right") - (AHEAD, 0.0, UP))) is None
    assert np.linalg.norm(way, axis=1).max() < LENGTH + 0.005  # [m]


def test_stops_where_the_hand_carries_most_of_the_gown():
    run = bench(lambda height: 1.2 + 20.0 * max(height, 0.0))  # [N]: the whole gown 8 cm above the hook
    assert ended(run) is None
    assert 0.08 < hand_from_base(run.world, "right")[2] - UP < 0.12  # [m]


def test_folds_that_were_taken_too_are_felt_below_the_hook():
    run = bench(lambda height: 2.7)
    assert ended(run) == Reason.MULTI_LAYER
    assert hand_from_base(run.world, "right")[2] < UP  # [m]


def test_a_corner_that_slips_on_the_way_is_missed():
    run = bench(lambda height: 1.2 if height < 0.0 else 0.1)
    assert ended(run) == Reason.GRASP_MISSED


def test_the_corner_goes_sideways_below_the_hook_and_behind_the_rail_above_it():
    run = bench(lambda height: 1.2)
    way = []
    assert ended(run, each_tick=lambda: way.append(hand_from_base(run.world, "right") - (AHEAD, 0.0, UP))) is None
    ahead, left, up = np.array(way).T
    below = up < -0.05  # [m]
    assert left[below].min() < -0.30  # [m]: as far aside as the strip is long
    assert ahead[below].max() < 0.03  # [m]: not behind the rail
    assert ahead[-1] > 0.12  # [m]: in the end
