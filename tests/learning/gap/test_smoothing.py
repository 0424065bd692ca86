import numpy as np
import pytest
from caretree.learning.gap.smoothing import bandwidth, derivative, lowpass, resample

T = np.arange(0.0, 10.0, 0.005)


@pytest.mark.parametrize("order", [1, 2])
def test_derivative_of_a_sine_is_exact_away_from_the_ends(order):
    w = 2 * np.pi * 0.7
    x = np.sin(w * T)
    truth = w * np.cos(w * T) if order == 1 else -(w**2) * x
    out = derivative(x, 0.005, 20.0, order)
    assert np.abs(out - truth)[200:-200].max() < 2e-3 * w**order


def test_lowpass_keeps_the_motion_and_removes_the_noise():
    rng = np.random.default_rng(0)
    x = np.sin(2 * np.pi * 0.5 * T)
    out = lowpass(x + 0.1 * rng.normal(size=len(T)), 0.005, 3.0)
    assert np.std((out - x)[100:-100]) < 0.03


def test_bandwidth_finds_the_last_line_above_the_noise():
    rng = np.random.default_rng(1)
    x = np.sin(2 * np.pi * 0.5 * T) + 0.3 * np.sin(2 * np.pi * 2.0 * T) + 1e-3 * rng.normal(size=len(T))
    cutoff, noise = bandwidth(x, 0.005)
    assert 1.9 < cutoff < 6.0
    assert noise == pytest.approx(1e-3, rel=0.25)


def test_resample_makes_uneven_steps_even():
    t = np.sort(np.concatenate([T[::2], T[1:100:2]]))
    grid, out, dt = resample(t, np.sin(t)[:, None])
    assert np.allclose(np.diff(grid), dt)
    assert np.abs(out[:, 0] - np.sin(grid)).max() < 1e-4
