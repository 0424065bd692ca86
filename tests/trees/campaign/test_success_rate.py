"""Wilson's interval against published values and its own laws."""

import pytest
from caretree.sim.errors import CaretreeError
from caretree.trees.campaign.success_rate import SuccessRate


@pytest.mark.parametrize(
    ("successes", "trials", "low", "high"),
    [
        # computed independently as the roots of (p - x)^2 = z^2 x (1 - x) / n
        (10, 10, 0.7225, 1.0),
        (0, 10, 0.0, 0.2775),
        (8, 10, 0.4902, 0.9433),
        (181, 200, 0.8565, 0.9384),
    ],
)
def test_known_intervals(successes, trials, low, high):
    assert SuccessRate(successes=successes, trials=trials).interval() == pytest.approx((low, high), abs=5e-4)


def test_bounds_solve_the_score_equation():
    z = 1.959964
    for successes, trials in ((1, 7), (5, 9), (40, 41)):
        share = successes / trials
        for bound in SuccessRate(successes=successes, trials=trials).interval():
            assert (share - bound) ** 2 == pytest.approx(z * z * bound * (1 - bound) / trials)


def test_no_trials_say_nothing():
    nothing = SuccessRate(successes=0, trials=0)
    assert nothing.rate is None
    assert nothing.interval() == (0.0, 1.0)
    assert str(nothing) == "-"
    assert str(SuccessRate(successes=9, trials=10)) == "9/10 = 90% [60, 98]"


def test_impossible_counts_are_refused():
    with pytest.raises(CaretreeError, match="11 successes in 10 trials"):
        SuccessRate(successes=11, trials=10)
