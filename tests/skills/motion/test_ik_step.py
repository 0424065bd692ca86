"""The compiled step is that of numpy's general solver."""

import numpy as np
import pytest
from caretree.skills.motion.ik_step import ik_step


def solved(J, error, drift, damping):
    return drift + J.T @ np.linalg.solve(J @ J.T + damping * np.eye(len(J)), error - J @ drift)


def plainly(J, error, drift, damping, q, lower, upper, rounds):
    step, free, taken = solved(J, error, drift, damping), np.ones(len(q), bool), 0
    low, high = q <= lower, q >= upper
    for _ in range(rounds - 1):
        blocked = (low & (step < 0)) | (high & (step > 0))
        if not blocked.any():
            break
        free &= ~blocked
        step, taken = np.zeros(len(q)), int((~free).sum())
        step[free] = solved(J[:, free], error, drift[free], damping)
    return step, taken


@pytest.mark.parametrize("rows", [3, 5, 6])
@pytest.mark.parametrize("at_limits", range(8))
def test_steps(rows, at_limits):
    rng, most = np.random.default_rng(rows), 0
    lower, upper = -np.ones(7), np.ones(7)
    for _ in range(200):
        q = rng.uniform(-0.9, 0.9, 7)
        q[rng.permutation(7)[:at_limits]] = rng.choice((-1.0, 1.0), at_limits)
        given = rng.normal(size=(rows, 7)), rng.normal(size=rows), 0.1 * rng.normal(size=7), rng.choice((1e-3, 0.1))
        expected, taken = plainly(*given, q, lower, upper, 3)
        np.testing.assert_allclose(ik_step(*given, q, lower, upper, 3), expected, rtol=1e-10, atol=1e-10)
        most = max(most, taken)
    assert (most > 0) == (at_limits > 0)


def test_a_singular_task_is_damped():
    """Two rows alike: the step is that of LAPACK as far as the damping fixes it."""
    rng = np.random.default_rng(9)
    for damping in (1e-6, 1e-3, 0.1):
        J = rng.normal(size=(6, 7))
        J[5] = J[4]
        given = J, rng.normal(size=6), np.zeros(7), damping
        expected = solved(*given)
        found = ik_step(*given, np.zeros(7), -np.ones(7), np.ones(7), 3)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * np.abs(expected).max())
