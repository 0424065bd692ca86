import numpy as np
import pytest
from caretree.learning.gap.joints.noise import autocorrelation, estimate_noise, repeat_difference


def coloured(rng, n, a=0.95):
    x = np.zeros(n)
    for i in range(1, n):
        x[i] = a * x[i - 1] + rng.normal()
    return x


def test_repeats_give_the_noise_and_not_what_they_share():
    rng = np.random.default_rng(0)
    motion = np.sin(np.linspace(0, 9, 400))[:, None]
    shared = 5.0 * motion
    series = [shared + 0.3 * rng.normal(size=(400, 1)) for _ in range(4)]
    deviation = repeat_difference(series, [motion] * 4)
    assert len(deviation) == 4
    assert estimate_noise(deviation, "repeats").rms[0] == pytest.approx(0.3, rel=0.1)


def test_different_motions_do_not_count_as_repeats():
    t = np.linspace(0, 9, 400)
    assert repeat_difference([np.zeros((400, 1))] * 2, [np.sin(t)[:, None], np.cos(t)[:, None]]) == []


def test_slow_noise_makes_a_constant_worth_far_fewer_rows():
    rng = np.random.default_rng(1)
    noise = estimate_noise([coloured(rng, 3000)[:, None] for _ in range(4)], "residual")
    lags = noise.acf.shape[1]
    ones = autocorrelation([np.ones((3000, 1))] * 4, lags)
    jitter = autocorrelation([rng.normal(size=(3000, 1)) for _ in range(4)], lags)
    assert noise.widening(ones, 0)[0] > 15.0  # the truth is (1 + a) / (1 - a) = 39
    assert noise.widening(jitter, 0)[0] < 2.5
