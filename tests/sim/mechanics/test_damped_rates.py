"""The compiled rates are those of the formula written with LAPACK, to rounding, also at singularities and limits."""

import numpy as np
import pytest
from caretree.sim.mechanics.damped_rates import damped_rates
from caretree.sim.mechanics.kinematics import Kinematics
from caretree.sim.robot.baxter import BAXTER

SIDES = ("left", "right")


@pytest.fixture(scope="module")
def kinematics():
    return Kinematics(BAXTER)


def by_lapack(J, velocity, q, joints, centring, dt):
    """The formula as numpy writes it, and how many joints it took out."""
    lower, upper, speed, rest = joints
    room = 0.5 / max(dt, 1e-6)
    low, high = np.maximum(-speed, (lower - q) * room), np.minimum(speed, (upper - q) * room)
    pull = centring * (rest - q)
    free, rates = np.ones(len(q), bool), np.zeros(len(q))
    for _ in range(3):
        counts = np.where(np.arange(6) < 3, 1.0, 1.0 if free.sum() > 5 else 0.15)
        Jf = J[:, free] * counts[:, None]
        left = (velocity - J[:, ~free] @ rates[~free]) * counts
        U, S, Vt = np.linalg.svd(Jf, full_matrices=False)
        damping = 0.04**2 * (1.0 - np.minimum(S / 0.06, 1.0) ** 2)
        rates[free] = Vt.T @ (S / (S**2 + damping) * (U.T @ (left - Jf @ pull[free]))) + pull[free]
        over = (rates < low - 1e-9) | (rates > high + 1e-9)
        at_limit = over & free & ((q - lower < 0.05) | (upper - q < 0.05))
        if not at_limit.any():
            break
        rates[at_limit] = np.clip(rates[at_limit], low[at_limit], high[at_limit])
        free &= ~at_limit
    scale = np.max(np.abs(rates) / speed)
    return np.clip(rates / max(scale, 1.0), low, high), int((~free).sum())


def state(kinematics, side, rng, at_limits=0, fast=1.0):
    limits = kinematics.limits[side]
    joints = np.stack((limits.lower, limits.upper, limits.velocity, BAXTER.ready[SIDES.index(side)]))
    q = rng.uniform(limits.lower, limits.upper)
    for n in rng.permutation(7)[:at_limits]:
        q[n] = limits.lower[n] + rng.uniform(0, 0.002) if rng.uniform() < 0.5 else limits.upper[n]
    velocity = fast * rng.normal(size=6) * np.repeat((0.1, 0.4), 3)
    return [kinematics.pose_and_jacobian_local(side, q)[1], velocity, q, joints, rng.uniform(0, 0.4), 0.01]


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("at_limits", range(8))
def test_anywhere_and_at_limits(kinematics, side, at_limits):
    rng, taken_out = np.random.default_rng(at_limits), set()
    for _ in range(200):
        given = state(kinematics, side, rng, at_limits, fast=rng.choice((0.1, 1.0, 10.0)))
        expected, fixed = by_lapack(*given)
        np.testing.assert_allclose(damped_rates(*given), expected, rtol=0, atol=1e-10)
        taken_out.add(fixed)
    assert max(taken_out) >= min(at_limits, 4)


@pytest.mark.parametrize("rank", range(6))
def test_at_singularities(kinematics, rank):
    """Directions in which the hand cannot move, or hardly, are given up alike."""
    rng = np.random.default_rng(rank)
    for _ in range(100):
        given = state(kinematics, "left", rng)
        U, S, Vt = np.linalg.svd(given[0], full_matrices=False)
        S[rank:] = rng.choice((0.0, 1e-12, 1e-6, 1e-3, 0.0599, 0.0601), size=6 - rank)
        given[0] = np.asfortranarray(U * S @ Vt)
        expected, _ = by_lapack(*given)
        np.testing.assert_allclose(damped_rates(*given), expected, rtol=0, atol=1e-10)


def test_a_stretched_arm(kinematics):
    q = np.zeros(7)
    given = state(kinematics, "left", np.random.default_rng(3))
    given[0], given[2] = kinematics.pose_and_jacobian_local("left", q)[1], q
    np.testing.assert_allclose(damped_rates(*given), by_lapack(*given)[0], rtol=0, atol=1e-10)


def test_no_way_that_reaches_the_velocity_is_missed(kinematics):
    """In the open the hand moves exactly as wanted."""
    rng = np.random.default_rng(5)
    for _ in range(50):
        given = state(kinematics, "right", rng, fast=0.02)
        if np.linalg.svd(given[0])[1].min() > 0.07 and by_lapack(*given)[1] == 0:
            np.testing.assert_allclose(given[0] @ damped_rates(*given), given[1], atol=1e-12)
