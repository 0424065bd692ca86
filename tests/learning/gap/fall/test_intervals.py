import numpy as np
import pytest
from caretree.learning.gap.fall.colour import colour, grid
from caretree.learning.gap.fall.fit import Drop, fit_drops, lifted
from caretree.learning.gap.fall.intervals import intervals
from scipy.signal import lfilter

T = np.arange(0.0, 1.6, 0.04)


def drops(seed, memory):
    """Three drops from 20 m with linear drag of 0.3 1/s and 1 cm of noise, remembered from sample to sample."""
    rng, out = np.random.default_rng(seed), []
    for k in range(3):
        h = 20.0 - 9.81 * (T - (1.0 - np.exp(-0.3 * T)) / 0.3) / 0.3
        noise = lfilter([np.sqrt(1.0 - memory**2)], [1.0, -memory], rng.normal(size=len(T) + 100))[100:]
        out.append(Drop(name=f"d{k}", t=T, h=h + 0.01 * noise))
    return out


def test_slow_noise_makes_the_interval_as_wide_as_it_has_to_be():
    colours, held, too_sure = grid([T] * 3), 0, 0
    white = colours[:1]
    for seed in range(40):
        fit = fit_drops(drops(seed, 0.7), ("linear_drag",), "together")
        low, high = intervals(fit, colours)
        held += low[0] <= 0.3 <= high[0]
        low, high = intervals(fit, white)
        too_sure += low[0] <= 0.3 <= high[0]
    assert held >= 34
    assert too_sure < held


def test_of_one_colour_it_is_least_squares():
    fit = fit_drops(drops(1, 0.0), ("linear_drag",), "together")
    low, high = intervals(fit, [colour([T] * 3, 0.04, 0.0)])
    error = np.sqrt(np.linalg.inv(fit.information)[0, 0] * fit.rss / (3 * len(T) - 4))
    assert 0.5 * (low[0] + high[0]) == pytest.approx(fit.theta[0], abs=0.02 * error)
    assert high[0] - low[0] == pytest.approx(2.0 * 1.981 * error, rel=0.01)


def test_a_drop_whose_noise_is_slow_does_not_make_the_others_look_so():
    """With white noise on two drops and slow noise on one, it is between the intervals of all white and all slow."""
    colours = grid([T] * 3)
    widths = []
    for slow in ((), (2,), (0, 1, 2)):
        white, remembered = drops(3, 0.0), drops(3, 0.9)
        mixed = [remembered[k] if k in slow else white[k] for k in range(3)]
        low, high = intervals(fit_drops(mixed, ("linear_drag",), "together"), colours)
        widths.append(high[0] - low[0])
    assert widths[0] < widths[1] < widths[2]


def test_the_lift_of_the_air_may_act_or_not():
    lift, thrown = 0.002, drops(2, 0.0)
    fit = fit_drops(thrown, ("linear_drag",), "together")
    colours = grid([T] * 3)
    low, high = intervals(fit, colours)
    lower, higher = intervals(fit, colours, thrown, lift)
    assert higher[0] == high[0]
    assert lower[0] < low[0]

    def left(rate):
        return fit_drops(thrown, ("linear_drag", "buoyancy"), "together", start=np.array([rate, lift])).rss

    change = lifted(fit, thrown, lift)[0]
    assert left(fit.theta[0] + change) < min(left(fit.theta[0] + share * change) for share in (0.0, 0.8, 1.2))
