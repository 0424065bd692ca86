import numpy as np
from caretree.learning.gap.fall.fit import Drop, fit_drops
from caretree.learning.gap.fall.leftover import repeating


def drops(force, noise=0.01):
    """Four drops under gravity and `force(t)` [m/s^2], 120 samples a second."""
    fine = np.arange(0.0, 2.0, 1e-3)
    way = -0.5 * 9.81 * fine**2 + np.cumsum(np.cumsum(force(fine)) * 1e-3) * 1e-3
    t = np.arange(0.0, 1.95, 1.0 / 120.0)
    out = []
    for k in range(4):
        h = 25.0 + np.interp(t, fine, way) + noise * np.random.default_rng([5, k]).normal(size=len(t))
        out.append(Drop(name=f"d{k}", t=t, h=h))
    return out


def left_over(made):
    return repeating(fit_drops(made, (), "together"), made)


def test_nothing_repeats_in_noise():
    assert left_over(drops(lambda t: 0.0 * t)).p_value > 0.01


def test_a_short_push_is_seen_and_placed():
    found = left_over(drops(lambda t: 0.4 * np.exp(-(((t - 1.2) / 0.1) ** 2))))
    assert found.p_value < 1e-4
    assert "push" in found.what
    assert abs(float(found.what.split()[3]) - 1.2) < 0.2


def test_a_swing_is_seen_with_its_period():
    found = left_over(drops(lambda t: 0.3 * np.sin(2.0 * np.pi * t / 0.5)))
    assert found.p_value < 1e-4
    assert "swings" in found.what
    assert abs(float(found.what.split("period of ")[1].split()[0]) - 0.5) < 0.1
