import numpy as np
import pytest
from caretree.learning.gap.fall.fit import Drop, fit_drops

T = np.arange(0.0, 1.6, 0.02)


def drops(linear=0.3, late=(0.0, 0.0, 0.0), factors=(1.0, 1.0, 1.0)):
    """Drops from 20 m with linear drag [1/s] per mass of the body without ballast, with 1 mm of noise."""
    out = []
    for k, (wait, factor) in enumerate(zip(late, factors, strict=True)):
        s, rate = np.maximum(T - wait, 0.0), linear / factor
        h = 20.0 - 9.81 * (s - (1.0 - np.exp(-rate * s)) / rate) / rate
        out.append(Drop(name=f"d{k}", t=T, h=h + 1e-3 * np.random.default_rng(k).normal(size=len(T)), factor=factor))
    return out


@pytest.mark.parametrize(
    ("mode", "late"), [("together", (0.0, 0.0, 0.0)), ("late", (0.1, 0.1, 0.1)), ("free", (0.0, 0.1, 0.2))]
)
def test_drag_and_releases_are_found_together(mode, late):
    fit = fit_drops(drops(late=late), ("linear_drag",), mode)
    assert fit.values["linear_drag"]["rate"] == pytest.approx(0.3, abs=0.005)
    assert fit.releases[:, 0] == pytest.approx([20.0] * 3, abs=0.01)
    assert fit.releases[:, 1] == pytest.approx(late, abs=0.01)
    assert np.std(np.concatenate(fit.residuals)) == pytest.approx(1e-3, rel=0.2)
    assert sum(p.sum() for p in fit.parts) == pytest.approx(fit.rss)


def test_ballast_shares_one_drag_per_mass():
    assert fit_drops(drops(factors=(1.0, 3.0, 0.5)), ("linear_drag",)).values["linear_drag"]["rate"] == pytest.approx(
        0.3, abs=0.005
    )


def test_values_and_lateness_that_are_given_are_kept():
    fit = fit_drops(drops(late=(0.1, 0.1, 0.1)), ("linear_drag",), "late", start=np.array([0.2]), late=0.05)
    assert fit.values["linear_drag"]["rate"] == 0.2
    assert fit.releases[:, 1] == pytest.approx([0.05] * 3, abs=0.0)
    assert fit.rss > 10.0 * fit_drops(drops(late=(0.1, 0.1, 0.1)), ("linear_drag",), "late").rss


def test_a_fit_that_begins_at_its_own_end_stays_there():
    some = drops()
    first = fit_drops(some, ("linear_drag",), "free")
    again = fit_drops(some, ("linear_drag",), "free", near=first)
    assert again.theta == pytest.approx(first.theta, abs=1e-5)
    assert again.rss == pytest.approx(first.rss, rel=1e-6)
