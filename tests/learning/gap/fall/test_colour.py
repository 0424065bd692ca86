"""The colour of a drop's noise, and what is left over that no set of effects explains."""

import numpy as np
import pytest
from caretree.learning.gap.fall.colour import colour, estimated, grid
from caretree.learning.gap.fall.fit import Drop, fit_drops
from caretree.learning.gap.fall.leftover import repeating

STEP, ROWS = 0.02, 90


def noises(memory, slow, count, rms=0.02, seed=0):
    rng = np.random.default_rng(seed)
    out = []
    for _ in range(count):
        x = np.zeros(ROWS + 200)
        keep = np.exp(-STEP / memory)
        for k in range(1, len(x)):
            x[k] = keep * x[k - 1] + np.sqrt(1 - keep**2) * rng.normal()
        out.append(rms * (np.sqrt(slow) * x[200:] + np.sqrt(1 - slow) * rng.normal(size=ROWS)))
    return out


def test_whitening_makes_samples_independent_and_of_unit_variance():
    t = STEP * np.arange(ROWS)
    c = colour([t, t[:50]], 0.1, 0.7)
    x = np.stack([c.white[0] @ n for n in noises(0.1, 0.7, 300, rms=1.0)])
    assert np.mean(x**2) == pytest.approx(1.0, abs=0.05)
    assert abs(np.mean(x[:, 1:] * x[:, :-1])) < 0.03
    assert c.white[1].shape == (50, 50)


@pytest.mark.parametrize(("memory", "slow"), [(0.12, 0.85), (0.03, 0.5)])
def test_the_colour_is_found_again_in_what_a_fit_leaves(memory, slow):
    t = STEP * np.arange(ROWS)
    noise = noises(memory, slow, 6)
    columns = np.kron(np.eye(6), np.stack([np.ones(ROWS), t, t**2], axis=1))
    r = np.concatenate(noise)
    r = r - columns @ np.linalg.lstsq(columns, r, rcond=None)[0]
    found = estimated(grid([t] * 6), r, columns)
    assert found.slow * (found.memory / STEP) == pytest.approx(slow * (memory / STEP), rel=0.6)


def drops(extra):
    t = STEP * np.arange(ROWS)
    return [
        Drop(name=str(k), t=t, h=20.0 + k - 0.5 * 9.81 * t**2 + extra(t, 20.0 + k - 0.5 * 9.81 * t**2) + n)
        for k, n in enumerate(noises(0.05, 0.5, 4))
    ]


@pytest.mark.parametrize(
    ("extra", "seen", "word"),
    [
        (lambda t, h: 0.0 * t, False, ""),
        (lambda t, h: 0.1 * np.sin(12.0 * t), True, "force"),
        (lambda t, h: 0.2 * np.sin(1.3 * h), True, "over the height"),
    ],
)
def test_what_repeats_from_drop_to_drop_is_noticed(extra, seen, word):
    given = drops(extra)
    left = repeating(fit_drops(given, ()), given)
    assert (left.p_value < 2e-3) == seen
    if seen:
        assert word in left.what
