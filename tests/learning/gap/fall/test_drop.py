"""The closed form of a drop against step-by-step integration, and what the benchmark's ideal observer says."""

import numpy as np
import pytest
from caretree.learning.gap.bench.fall_oracle import apart, precision
from caretree.learning.gap.fall.drop import STEP, fallen, height

G = 9.81


def integrated(duration, linear, quadratic, wind):
    out, x, v, h = [(0.0, 0.0)], 0.0, 0.0, 1e-3
    for k in range(1, int(duration / h) + 1):
        half = v + 0.5 * h * (G - linear * v - quadratic * abs(v + wind) * (v + wind))
        a = G - linear * half - quadratic * abs(half + wind) * (half + wind)
        x, v = x + h * (v + 0.5 * h * a), v + h * a
        if k % 10 == 0:
            out.append((x, v))
    return np.array(out)


@pytest.mark.parametrize(
    ("linear", "quadratic", "wind"),
    [
        (0.0, 0.0, 0.0),
        (1e-5, 0.0, 0.0),
        (0.3, 0.0, 0.0),
        (0.0, 1e-9, 0.0),
        (0.0, 0.02, 0.0),
        (0.2, 0.05, 4.0),
        (0.0, 0.05, -6.0),  # the air sinks faster at first, then the body overtakes it
        (2.0, 0.05, -6.0),  # the body never overtakes it
        (0.3, 1e-8, -3.0),
        (0.0, 0.001, -30.0),  # the air is overtaken only after the fall
    ],
)
def test_closed_form_is_what_integration_gives(linear, quadratic, wind):
    table = fallen(2.0, linear, quadratic, wind, G)
    slow = integrated(2.0, linear, quadratic, wind)
    assert table[: len(slow), 0] == pytest.approx(STEP * np.arange(len(slow)))
    assert np.abs(table[: len(slow), 1:] - slow).max() < 2e-4


def test_a_drag_of_the_wrong_sign_still_gives_numbers():
    assert np.isfinite(fallen(6.2, -0.4, -0.0024, -1.8, G)).all()


def test_height_before_the_release_is_the_releases():
    table = fallen(1.0, 0.0, 0.0, 0.0, G)
    h, v = height(np.array([0.0, 0.1, 0.305]), table, 5.0, 0.1)
    assert h == pytest.approx([5.0, 5.0, 5.0 - 0.5 * G * 0.205**2])
    assert v == pytest.approx([0.0, 0.0, G * 0.205])


def drops(values):
    t = np.arange(0.0, 2.0, 0.02)
    s, z = path(values)
    h = (1.0 + values.get("gain_error", 0.0)) * np.interp(t - values.get("delay", 0.0), s, z)
    return [(t, h, precision(len(t), 0.02, 0.02, 0.05, 0.5))] * 3


def path(values):
    table = fallen(
        2.6,
        values.get("linear_drag", 0.0),
        values.get("quadratic_drag", 0.0) + values.get("wind", 0.0),
        values.get("updraft", 0.0),
        G * (1.0 - values.get("buoyancy", 0.0)),
    )
    return table[:, 0], -table[:, 1]


def test_a_clear_pair_is_far_from_its_rivals_and_two_drags_are_not():
    clear = {"quadratic_drag": 0.02, "delay": 0.1}
    alike = {"linear_drag": 0.02, "quadratic_drag": 0.001}
    assert apart(tuple(clear), drops(clear), path, None) > 4.0
    assert apart(tuple(alike), drops(alike), path, None) < 2.0


def test_whitened_noise_is_white():
    rng = np.random.default_rng(0)
    slow = np.zeros((400, 50))
    slow[:, 0] = rng.normal(size=400)
    for k in range(1, 50):
        slow[:, k] = np.exp(-0.2) * slow[:, k - 1] + np.sqrt(1 - np.exp(-0.4)) * rng.normal(size=400)
    noise = 0.03 * (np.sqrt(0.7) * slow + np.sqrt(0.3) * rng.normal(size=(400, 50)))
    white = noise @ precision(50, 0.02, 0.03, 0.1, 0.7).T
    assert np.mean(white**2) == pytest.approx(1.0, abs=0.05)
    assert abs(np.mean(white[:, 1:] * white[:, :-1])) < 0.03
