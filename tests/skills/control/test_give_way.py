import numpy as np
import pytest
from caretree.skills.control.give_way import GiveWay, GiveWayTuning

TICK = 1 / 15  # [s]


def held(stiffness, tuning, *, ticks=150, late=1, drift=0.002):
    """Pulls (n,) of an arm of some stiffness [N/m] that drifts off [m/s] the hand, which knows them `late` ticks."""
    giving, hand, pulls = GiveWay(tuning), 0.0, []
    for n in range(ticks):
        pulls.append(stiffness * (drift * n * TICK - hand))
        known = pulls[-1 - late] if n >= late else 0.0
        hand += TICK * giving.velocity(np.array((known, 0.0, 0.0)), n * TICK)[0]
    return np.array(pulls)


@pytest.mark.parametrize("stiffness", [7e3, 45e3])
def test_a_stiff_arm_and_the_hand_do_not_swing_against_each_other(stiffness):
    assert np.abs(held(stiffness, GiveWayTuning())).max() < 25.0
    fixed = GiveWayTuning(first=0.004, least=0.004, most=0.004)
    assert np.abs(held(stiffness, fixed)).max() > 100.0, "as they do where it always gives way as fast"


def test_a_pull_that_stays_is_given_way_to_ever_faster_up_to_a_limit():
    giving, pull = GiveWay(), np.array((10.0, 0.0, 0.0))
    speeds = [giving.velocity(pull, n * TICK)[0] for n in range(60)]
    assert speeds[0] == pytest.approx(10.0 * GiveWayTuning().first)
    assert (np.diff(speeds) >= 0.0).all()
    assert speeds[-1] == pytest.approx(10.0 * GiveWayTuning().most)


def test_once_it_turns_back_it_is_slower_and_another_hold_begins_anew():
    giving, pull = GiveWay(), np.array((10.0, 0.0, 0.0))
    first = giving.velocity(pull, 0.0)[0]
    assert giving.velocity(-pull, TICK)[0] == pytest.approx(-10.0 * GiveWayTuning().least)
    assert giving.velocity(pull, 5.0)[0] == pytest.approx(first)
