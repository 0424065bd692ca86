"""What one hand took is lifted straight up and weighed."""

import numpy as np
import pytest
from caretree.skills.core.reasons import Reason
from caretree.skills.unhook import Unhook

from .hung_gown import DOWN, at, bench_with, ended, hand_from_base, holding

PLACE = (0.95, -0.22, 1.15)  # of the hand, from the middle of the base [m]
ARMS = holding(right=at(*PLACE))


def bench(weight, **ports):
    """The right hand has the gown; `weight` gives its load by the height it was lifted [N], [m]."""
    return bench_with(
        lambda context: Unhook("unhook", context, hand="right", **ports),
        arms=ARMS,
        pull=lambda side, hand: (weight(hand[2] - PLACE[2]) if side == "right" else 0.0) * DOWN,
    )


def test_lifts_by_the_height_and_tells_the_weight():
    run = bench(lambda lifted: 0.7 if lifted < 0.15 else 3.5, height=0.2)
    assert ended(run) is None
    assert hand_from_base(run.world, "right") == pytest.approx(np.add(PLACE, (0.0, 0.0, 0.2)), abs=0.01)  # [m]
    assert run.skill.load == pytest.approx(3.5, abs=0.05)  # [N]: of the gown that hangs free, not on the way


def test_goes_straight_up():
    run = bench(lambda lifted: 3.5, height=0.2)
    way = []
    assert ended(run, each_tick=lambda: way.append(hand_from_base(run.world, "right")[:2])) is None
    assert np.abs(np.array(way) - PLACE[:2]).max() < 0.01  # [m]


def test_a_hand_that_carries_less_than_a_gown_has_missed_it():
    assert ended(bench(lambda lifted: 1.0)) == Reason.GRASP_MISSED


def test_higher_than_the_arm_reaches_is_refused():
    run = bench(lambda lifted: 3.5, height=1.2)
    assert ended(run) == Reason.UNREACHABLE
    assert run.sent == 0
