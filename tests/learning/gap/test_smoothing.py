import numpy as np
import pytest
from caretree.learning.gap.smoothing import bandwidth, derivative, lowpass, lowpass_both, resample
from scipy.signal import lfilter

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
    assert 1.9 < cutoff < 16.5  # as wide as the noise of the acceleration allows
    assert noise == pytest.approx(1e-3, rel=0.25)


def test_resample_makes_uneven_steps_even():
    t = np.sort(np.concatenate([T[::2], T[1:100:2]]))
    grid, out, dt = resample(t, np.sin(t)[:, None])
    assert np.allclose(np.diff(grid), dt)
    assert np.abs(out[:, 0] - np.sin(grid)).max() < 1e-4


def motion_at_1_khz():
    """Six seconds of motion up to 2.5 Hz."""
    t = np.arange(0.0, 6.0, 1e-3)
    return t, 0.1 * sum(np.sin(2 * np.pi * f * t + f) / f for f in (0.5, 1.0, 1.5, 2.5))


def test_noise_that_the_sensor_filtered_is_not_taken_for_motion():
    t, x = motion_at_1_khz()
    pole = np.exp(-2 * np.pi * 80.0 * 1e-3)  # of a sensor's own filter, passed twice
    noise = np.random.default_rng(100).normal(size=len(t))
    for _ in range(2):
        noise = lfilter([1.0 - pole], [1.0, -pole], noise)
    assert 5.0 < bandwidth(x + 2e-5 * noise, 1e-3)[0] < 25.0


def test_a_quiet_log_is_read_well_beyond_its_motion_and_a_noisy_one_is_not():
    t, x = motion_at_1_khz()
    noise = np.random.default_rng(100).normal(size=len(t))
    assert bandwidth(x + 1e-6 * noise, 1e-3)[0] > 10.0
    assert bandwidth(x + 3e-3 * noise, 1e-3)[0] < 10.0


def test_two_filters_in_one_pass_are_the_two_one_after_the_other():
    x = np.sin(2 * np.pi * 0.5 * T) + np.sin(2 * np.pi * 3.0 * T)
    both = lowpass_both(x, 0.005, 3.0, 4.0)
    assert both[200:-200] == pytest.approx(lowpass(lowpass(x, 0.005, 4.0), 0.005, 3.0)[200:-200], abs=1e-3)
    assert np.array_equal(lowpass_both(x, 0.005, np.inf, 3.0), lowpass(x, 0.005, 3.0))
