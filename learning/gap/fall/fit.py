"""Fit a set of effects to drops, together with each drop's own release height and instant."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from ....sim.effects.body_bank import BODY_EFFECTS
from .drop import GRAVITY, fallen, height

RELEASE = 0.6  # [s] the release may lie this far before or after the first sample
START = {"rate": 0.1, "coefficient": 0.02, "fraction": 0.0, "speed": 0.0}


@dataclass(frozen=True, kw_only=True)
class Drop:
    """One recorded drop.  t: (T,) [s] from its first sample, h: (T,) [m]."""

    name: str
    t: np.ndarray
    h: np.ndarray


@dataclass(frozen=True, kw_only=True)
class DropFit:
    """A fitted set of effects.

    Attributes:
        names: effects, in order.
        values: effect -> parameter -> value.
        theta: the same, flat.
        releases: (E, 2) release height [m] and instant [s] of each drop.
        residuals: one (T,) per drop [m].
        jacobian: d residual / d (theta, releases), stacked.
        rss: residual sum of squares.
    """

    names: tuple[str, ...]
    values: dict[str, dict[str, float]]
    theta: np.ndarray
    releases: np.ndarray
    residuals: list[np.ndarray]
    jacobian: np.ndarray
    rss: float


def unpack(names: tuple[str, ...], theta: np.ndarray) -> dict[str, dict[str, float]]:
    """Flat parameters as effect -> parameter -> value."""
    out, at = {}, 0
    for name in names:
        parameters = BODY_EFFECTS[name].parameters
        out[name] = {p.name: float(x) for p, x in zip(parameters, theta[at:at + len(parameters)], strict=True)}
        at += len(parameters)
    return out


def table_of(values: dict[str, dict[str, float]], duration: float) -> tuple[np.ndarray, float]:
    """Fall table under the effects, and the scale of the reading."""
    wind = values.get("wind", {"coefficient": 0.0, "speed": 0.0})
    quadratic = values.get("quadratic_drag", {"coefficient": 0.0})["coefficient"] + wind["coefficient"]
    gravity = GRAVITY * (1.0 - values.get("buoyancy", {"fraction": 0.0})["fraction"])
    table = fallen(duration, values.get("linear_drag", {"rate": 0.0})["rate"], quadratic, wind["speed"], gravity)
    return table, 1.0 + values.get("gain_error", {"fraction": 0.0})["fraction"]


def fit_drops(drops: list[Drop], names: tuple[str, ...], start: np.ndarray | None = None,
              fixed: bool = False) -> DropFit:
    """Least squares over effects and releases.

    Args:
        drops: the drops.
        names: effects to include (those of the body and `gain_error`).
        start: first guess of the flat parameters.
        fixed: keep the parameters at `start` and fit the releases alone.
    """
    parameters = [p for name in names for p in BODY_EFFECTS[name].parameters]
    k = len(parameters)
    theta = np.array([START[p.name] for p in parameters]) if start is None else np.asarray(start, dtype=float)
    moving = 0 if fixed else k
    duration = max(float(d.t[-1]) for d in drops) + RELEASE + 0.1
    first = np.concatenate([theta[:moving], *([[d.h[:3].mean(), 0.0] for d in drops])])
    low = np.concatenate([[p.lower for p in parameters][:moving], *([[-np.inf, -RELEASE]] * len(drops))])
    high = np.concatenate([[p.upper for p in parameters][:moving], *([[np.inf, RELEASE]] * len(drops))])

    def model(x: np.ndarray) -> tuple[list[np.ndarray], list[np.ndarray], float]:
        table, scale = table_of(unpack(names, np.concatenate([x[:moving], theta[moving:]])), duration)
        h, v = zip(*(height(d.t, table, *x[moving + 2 * i:moving + 2 * i + 2]) for i, d in enumerate(drops)), strict=True)
        return list(h), list(v), scale

    def residual(x: np.ndarray) -> np.ndarray:
        h, _, scale = model(x)
        return np.concatenate([_read(a, scale, x[moving + 2 * i]) - d.h for i, (a, d) in enumerate(zip(h, drops, strict=True))])

    def jacobian(x: np.ndarray) -> np.ndarray:
        h, v, scale = model(x)
        J = np.zeros((sum(len(d.t) for d in drops), len(x)))
        base = np.concatenate([_read(a, scale, x[moving + 2 * i]) for i, a in enumerate(h)])
        for j in range(moving):
            step = 1e-5 * max(1.0, abs(x[j]))
            step = -step if x[j] + step > high[j] else step
            y = x.copy()
            y[j] += step
            moved, _, s = model(y)
            J[:, j] = (np.concatenate([_read(a, s, y[moving + 2 * i]) for i, a in enumerate(moved)]) - base) / step
        at = 0
        for i, d in enumerate(drops):
            rows = slice(at, at + len(d.t))
            J[rows, moving + 2 * i] = 1.0
            J[rows, moving + 2 * i + 1] = scale * v[i]
            at += len(d.t)
        return J

    first[:moving] = np.clip(first[:moving], low[:moving] + 1e-9, high[:moving] - 1e-9)
    solved = least_squares(residual, first, jac=jacobian, bounds=(low, high), x_scale="jac", max_nfev=60)
    r = residual(solved.x)
    ends = np.cumsum([len(d.t) for d in drops])[:-1]
    full = np.concatenate([solved.x[:moving], theta[moving:]])
    return DropFit(names=names, values=unpack(names, full), theta=full,
                   releases=solved.x[moving:].reshape(-1, 2), residuals=np.split(-r, ends), jacobian=jacobian(solved.x),
                   rss=float(r @ r))


def _read(h: np.ndarray, scale: float, release_height: float) -> np.ndarray:
    """Reading scaled about the release height, which each drop fits anyway."""
    return release_height + scale * (h - release_height)
