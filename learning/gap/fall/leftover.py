"""Whether something is left over that repeats from drop to drop: then what is missing is not in the bank.

Three free forms are tried: a force that bends slowly over the time since release, one that bends quickly, and a reading
of the height that is bent.  Effects and releases may give way to each of them, and the noise's colour is asked anew, so
that neither what the bank can still take up nor slow noise is mistaken for a discovery.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline
from scipy.stats import f as fisher

from .colour import Colour, grid, likelihood
from .drop import height
from .fit import RELEASE, DropFit, table_of

FORCES = (6, 14)  # pieces of the acceleration over the time since release
READING = 8  # pieces of a bent reading over the height


@dataclass(frozen=True, kw_only=True)
class Leftover:
    """What a free form removes beyond a set of effects.

    Attributes:
        energy: mean square it removes [m^2].
        p_value: of noise alone doing as well, corrected for the forms tried.
        what: the form, in words.
    """

    energy: float
    p_value: float
    what: str


def repeating(fit: DropFit, times: list[np.ndarray]) -> Leftover:
    """Let each free form, the same in all drops, compete with noise; the surest is returned.

    Args:
        fit: the best set of effects.
        times: sample times of each drop [s].
    """
    none = Leftover(energy=0.0, p_value=1.0, what="")
    if len(times) < 2:
        return none  # one drop cannot tell a repeating force from slow noise
    since = [np.maximum(t - r, 0.0) for t, r in zip(times, fit.releases[:, 1], strict=True)]
    colours = grid(times)
    found = [_force(fit, since, pieces, colours) for pieces in FORCES]
    found.append(_reading(fit, _paths(fit, times), colours))
    best = min(found, key=lambda x: x.p_value)
    return Leftover(energy=best.energy, p_value=min(len(found) * best.p_value, 1.0), what=best.what)


def _paths(fit: DropFit, times: list[np.ndarray]) -> list[np.ndarray]:
    """Heights the fit predicts, per drop [m]."""
    table, scale = table_of(fit.values, max(float(t[-1]) for t in times) + RELEASE + 0.1)
    return [
        top + scale * (height(t, table, top, when)[0] - top) for t, (top, when) in zip(times, fit.releases, strict=True)
    ]


def _pieces(low: float, high: float, count: int) -> list[BSpline]:
    knots = np.concatenate([[low] * 3, np.linspace(low, high, count - 2), [high] * 3])
    return [BSpline.basis_element(knots[i : i + 5], extrapolate=False) for i in range(count)]


def _force(fit: DropFit, since: list[np.ndarray], count: int, colours: list[Colour]) -> Leftover:
    end = max(float(s[-1]) for s in since)
    moments = np.linspace(0.0, end, 600)
    step = moments[1]
    bumps = np.stack([np.nan_to_num(b(moments)) for b in _pieces(0.0, end, count)], axis=1)
    way = np.cumsum(np.cumsum(bumps, axis=0) * step, axis=0) * step
    columns = np.concatenate([np.stack([np.interp(s, moments, f) for f in way.T], axis=1) for s in since])
    energy, p, theta = _pays(fit, columns, colours)
    when = float(moments[int(np.argmax(np.abs(bumps @ theta)))])
    return Leftover(
        energy=energy, p_value=p, what=f"a force that repeats from drop to drop, largest {when:.2f} s after release"
    )


def _reading(fit: DropFit, heights: list[np.ndarray], colours: list[Colour]) -> Leftover:
    low, high = min(float(h.min()) for h in heights), max(float(h.max()) for h in heights)
    columns = np.concatenate(
        [np.stack([np.nan_to_num(b(h)) for b in _pieces(low - 1e-6, high + 1e-6, READING)], axis=1) for h in heights]
    )
    energy, p, _ = _pays(fit, columns, colours)
    return Leftover(energy=energy, p_value=p, what="a reading that is bent over the height, the same in all drops")


def _pays(fit: DropFit, columns: np.ndarray, colours: list[Colour]) -> tuple[float, float, np.ndarray]:
    """Mean square [m^2] the columns remove, p-value, and their coefficients."""
    r = np.concatenate(fit.residuals)
    own = fit.jacobian / (np.linalg.norm(fit.jacobian, axis=0) + 1e-12)  # what effects and releases could still take up
    size = np.linalg.norm(columns, axis=0) + 1e-12
    both = np.column_stack([own, columns / size])
    colour = max(colours, key=lambda c: likelihood(c, r, both))
    white_r, white_own, white_both = colour.apply(r), colour.apply(own), colour.apply(both)
    plain, spent = _left(white_own, white_r)
    rich, full = _left(white_both, white_r)
    gained, free = max(full - spent, 1), max(len(r) - full, 1)
    p_value = float(fisher.sf(max(plain - rich, 0.0) / gained / (rich / free + 1e-30), gained, free))
    theta = np.linalg.lstsq(white_both, white_r, rcond=1e-6)[0]
    already, left = r - own @ np.linalg.lstsq(white_own, white_r, rcond=1e-6)[0], r - both @ theta
    energy = max(float(already @ already - left @ left) / len(r), 0.0)
    return energy, p_value, theta[own.shape[1] :] / size


def _left(columns: np.ndarray, y: np.ndarray) -> tuple[float, int]:
    """Residual sum of squares, and how many directions the columns span."""
    u, s, _ = np.linalg.svd(columns, full_matrices=False)
    u = u[:, s > 1e-6 * s[0]]
    return float(np.sum((y - u @ (u.T @ y)) ** 2)), u.shape[1]
