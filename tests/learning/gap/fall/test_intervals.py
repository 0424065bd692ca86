import numpy as np
import pytest
from caretree.learning.gap.fall.colour import colour, grid
from caretree.learning.gap.fall.fit import Drop, fit_drops
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
