"""Whether something is left over that repeats from drop to drop: then what is missing is not in the bank.

Free forms are tried: a force that bends over the time since release slowly or quickly, one short push, one swing, and
a reading of the height that is bent.  A push or a swing has one or two numbers besides its place and period, and is
seen where fourteen pieces of a force would drown it.  Effects and releases may give way to each form, and the noise's
colour is asked anew, so that neither what the bank can still take up nor slow noise is mistaken for a discovery.
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
PUSHES = (8, 14, 20)  # of which one alone is a push
SWINGS = 16  # periods tried
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
    found = [_push(fit, since, colours), _swing(fit, since, colours)]  # fewest numbers first: they win ties
    found += [_force(fit, since, pieces, colours) for pieces in FORCES]
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


def _ways(forces: np.ndarray, moments: np.ndarray, since: list[np.ndarray]) -> np.ndarray:
    """How far forces (M, k) at `moments` after release push each sample, (N, k)."""
    step = moments[1]
    way = np.cumsum(np.cumsum(forces, axis=0) * step, axis=0) * step
    return np.concatenate([np.stack([np.interp(s, moments, f) for f in way.T], axis=1) for s in since])


def _bumps(moments: np.ndarray, count: int) -> np.ndarray:
    return np.stack([np.nan_to_num(b(moments)) for b in _pieces(0.0, float(moments[-1]), count)], axis=1)


def _force(fit: DropFit, since: list[np.ndarray], count: int, colours: list[Colour]) -> Leftover:
    moments = np.linspace(0.0, max(float(s[-1]) for s in since), 600)
    bumps = _bumps(moments, count)
    energy, p, theta = _pays(fit, _ways(bumps, moments, since), colours)
    when = float(moments[int(np.argmax(np.abs(bumps @ theta)))])
    return Leftover(
        energy=energy, p_value=p, what=f"a force that repeats from drop to drop, largest {when:.2f} s after release"
    )


def _push(fit: DropFit, since: list[np.ndarray], colours: list[Colour]) -> Leftover:
    """One short force, wherever and as long as it fits best."""
    moments = np.linspace(0.0, max(float(s[-1]) for s in since), 600)
    bumps = np.concatenate([_bumps(moments, count) for count in PUSHES], axis=1)
    energy, p, k = _best_of(fit, _ways(bumps, moments, since), 1, colours)
    when = float(moments[int(np.argmax(bumps[:, k]))])
    return Leftover(energy=energy, p_value=p, what=f"a short push {when:.2f} s after release, the same in all drops")


def _swing(fit: DropFit, since: list[np.ndarray], colours: list[Colour]) -> Leftover:
    """One force that swings, of whatever period fits best."""
    end = max(float(s[-1]) for s in since)
    moments = np.linspace(0.0, end, 600)
    turns = 2.0 * np.pi * np.linspace(0.75, 0.5 * SWINGS + 0.25, SWINGS) / end
    waves = np.stack([f(w * moments) for w in turns for f in (np.sin, np.cos)], axis=1)
    energy, p, k = _best_of(fit, _ways(waves, moments, since), 2, colours)
    return Leftover(
        energy=energy,
        p_value=p,
        what=f"a force that swings with a period of {2.0 * np.pi / turns[k]:.2f} s, the same in all drops",
    )


def _best_of(fit: DropFit, columns: np.ndarray, each: int, colours: list[Colour]) -> tuple[float, float, int]:
    """Mean square [m^2] the best group of `each` columns removes, p-value over all groups, and which it is."""
    r, own = np.concatenate(fit.residuals), fit.jacobian / (np.linalg.norm(fit.jacobian, axis=0) + 1e-12)
    columns = columns / (np.linalg.norm(columns, axis=0) + 1e-12)
    colour = max(colours, key=lambda c: likelihood(c, r, own))
    y, base, X = colour.apply(r), colour.apply(own), colour.apply(columns)
    u, s, _ = np.linalg.svd(base, full_matrices=False)
    u = u[:, s > 1e-6 * s[0]]
    y, X = y - u @ (u.T @ y), X - u @ (u.T @ X)
    groups = [slice(i, i + each) for i in range(0, X.shape[1], each)]
    left = [_left(X[:, g], y)[0] for g in groups]
    k = int(np.argmin(left))
    energy, p, _ = _pays(fit, columns[:, groups[k]], colours)
    tried = float(len(groups))
    if each == 1:  # pushes that overlap are not as many chances
        spread = np.linalg.svd(X / (np.linalg.norm(X, axis=0) + 1e-12), compute_uv=False) ** 2
        tried = max(float(np.sum(spread) ** 2 / np.sum(spread**2)), 1.0)
    return energy, min(1.0, tried * p), k


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
    u = u[:, s > 1e-6 * s[0]] if s[0] > 0.0 else u[:, :0]
    return float(np.sum((y - u @ (u.T @ y)) ** 2)), u.shape[1]
