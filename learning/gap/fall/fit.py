"""Fit a set of effects to drops, together with each drop's own release height and instant."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from ....sim.effects.body.body_registry import BODY_EFFECTS
from .drop import GRAVITY, fallen, height

RELEASE = 0.6  # [s] the release may lie this far before or after the first sample
MODES = ("together", "late", "free")  # released at the first sample; all equally late; each at its own instant
START = {"rate": 0.1, "coefficient": 0.02, "fraction": 0.0, "speed": 0.0}


@dataclass(frozen=True, kw_only=True)
class Drop:
    """One recorded drop.

    Attributes:
        name: of the recording.
        t: (T,) [s] from its first sample.
        h: (T,) [m].
        white: (T, T) makes its noise white.
        factor: mass of the body with its ballast over that without.
    """

    name: str
    t: np.ndarray
    h: np.ndarray
    white: np.ndarray | None = None
    factor: float = 1.0


@dataclass(frozen=True, kw_only=True)
class DropFit:
    """A fitted set of effects.

    Attributes:
        names: effects, in order.
        mode: one of `MODES`.
        values: effect -> parameter -> value.
        theta: the same, flat.
        releases: (E, 2) release height [m] and instant [s] of each drop.
        residuals: one (T,) per drop [m].
        jacobian: d residual / d (theta, releases), stacked.
        rss: residual sum of squares, whitened where the drops carry their noise's colour.
        parts: (T,) squares it consists of, per drop.
        information: (p, p) of theta and releases, for noise of unit variance.
    """

    names: tuple[str, ...]
    mode: str
    values: dict[str, dict[str, float]]
    theta: np.ndarray
    releases: np.ndarray
    residuals: list[np.ndarray]
    jacobian: np.ndarray
    rss: float
    parts: list[np.ndarray]
    information: np.ndarray


def unpack(names: tuple[str, ...], theta: np.ndarray) -> dict[str, dict[str, float]]:
    """Flat parameters as effect -> parameter -> value."""
    out, at = {}, 0
    for name in names:
        parameters = BODY_EFFECTS[name].parameters
        out[name] = {p.name: float(x) for p, x in zip(parameters, theta[at : at + len(parameters)], strict=True)}
        at += len(parameters)
    return out


def table_of(values: dict[str, dict[str, float]], duration: float, factor: float = 1.0) -> tuple[np.ndarray, float]:
    """Fall table of the body `factor` times as heavy under the effects, and the scale of the reading."""
    values = {name: BODY_EFFECTS[name].ballasted(v, factor) for name, v in values.items()}
    wind = values.get("wind", {"coefficient": 0.0, "speed": 0.0})
    quadratic = values.get("quadratic_drag", {"coefficient": 0.0})["coefficient"] + wind["coefficient"]
    gravity = GRAVITY * (1.0 - values.get("buoyancy", {"fraction": 0.0})["fraction"])
    table = fallen(duration, values.get("linear_drag", {"rate": 0.0})["rate"], quadratic, wind["speed"], gravity)
    return table, 1.0 + values.get("gain_error", {"fraction": 0.0})["fraction"]


def instants_of(mode: str, drops: int) -> int:
    """How many release instants are free under what is assumed of them (one of `MODES`)."""
    return {"together": 0, "late": 1, "free": drops}[mode]


def fit_drops(
    drops: list[Drop],
    names: tuple[str, ...],
    mode: str = "free",
    start: np.ndarray | None = None,
    late: float | None = None,
    near: DropFit | None = None,
) -> DropFit:
    """Least squares over effects and releases.

    Args:
        drops: the drops.
        names: effects to include (those of the body and `gain_error`).
        mode: what is assumed of the release instants, one of `MODES`.
        start: keep the effects' parameters at these values and fit the releases alone.
        late: keep the common lateness at this value [s].
        near: begin at this fit of the same effects and mode.
    """
    problem = _DropProblem(drops, names, mode, start, late)
    low, high = problem.bounds
    solved = least_squares(
        problem.residual,
        problem.first(near),
        jac=problem.jacobian,  # pyright: ignore[reportArgumentType] - scipy's stubs know strings only
        bounds=(low, high),
        x_scale="jac",
        max_nfev=60,
    )
    return problem.fitted(solved.x)


def lifted(fit: DropFit, drops: list[Drop], lift: float) -> np.ndarray:
    """What a fit's numbers change by, effects and releases (p,), where a lift acts beside them.

    Args:
        fit: of the drops, without a lift among its effects.
        drops: the drops.
        lift: share of the weight, small.
    """
    problem = _DropProblem(drops, (*fit.names, "buoyancy"), fit.mode, np.append(fit.theta, lift), None)
    x = np.concatenate([fit.releases[:, 0], fit.releases[: instants_of(fit.mode, len(drops)), 1]])
    away = problem.residual(x) - problem.whitened(-np.concatenate(fit.residuals))
    return -np.linalg.lstsq(problem.whitened(fit.jacobian), away, rcond=None)[0]


class _DropProblem:
    """Residuals of drops over x = (effects' parameters that move, release heights, free release instants).

    Attributes:
        bounds: of x, lower and upper.
    """

    def __init__(
        self, drops: list[Drop], names: tuple[str, ...], mode: str, start: np.ndarray | None, late: float | None
    ) -> None:
        self._drops, self._names, self._mode = drops, names, mode
        parameters = [p for name in names for p in BODY_EFFECTS[name].parameters]
        self._theta = np.array([START[p.name] for p in parameters]) if start is None else np.asarray(start, dtype=float)
        self._moving = len(parameters) if start is None else 0
        self._instants = instants_of(mode, len(drops)) if late is None or mode != "late" else 0
        self._late = late or 0.0
        self._duration = max(float(d.t[-1]) for d in drops) + RELEASE + 0.1
        self._times, self._measured = np.concatenate([d.t for d in drops]), np.concatenate([d.h for d in drops])
        self._counts = [len(d.t) for d in drops]
        self._ends = np.cumsum(self._counts)[:-1]
        factor_of = np.repeat([d.factor for d in drops], self._counts)
        self._rows_of = {f: np.flatnonzero(factor_of == f) for f in dict.fromkeys(factor_of.tolist())}
        self._white = [d.white for d in drops if d.white is not None]
        own, e = parameters[: self._moving], len(drops)
        self.bounds = (
            np.concatenate([[p.lower for p in own], [-np.inf] * e, [-RELEASE] * self._instants]),
            np.concatenate([[p.upper for p in own], [np.inf] * e, [RELEASE] * self._instants]),
        )

    def first(self, near: DropFit | None) -> np.ndarray:
        """Where to begin: at a fit, or at typical values and the heights first seen."""
        k = self._moving
        if near is None:
            tops = [d.h[:3].mean() for d in self._drops]
            x = np.concatenate([self._theta[:k], tops, np.zeros(self._instants)])
        else:
            # all instants of a fit that is equally late are the same
            x = np.concatenate([near.theta[:k], near.releases[:, 0], near.releases[: self._instants, 1]])
        low, high = self.bounds
        x[:k] = np.clip(x[:k], low[:k] + 1e-9, high[:k] - 1e-9)
        return x

    def residual(self, x: np.ndarray) -> np.ndarray:
        """Predicted minus measured heights of all drops in a row, whitened."""
        return self.whitened(self._heights(x)[0] - self._measured)

    def jacobian(self, x: np.ndarray) -> np.ndarray:
        """Derivative of the residual with respect to x."""
        return self.whitened(self._change(x))

    def fitted(self, x: np.ndarray) -> DropFit:
        """The fit with everything others ask of it."""
        r, J = self.residual(x), self.jacobian(x)
        values, tops, release = self._split(x)
        return DropFit(
            names=self._names,
            mode=self._mode,
            values=unpack(self._names, values),
            theta=values,
            releases=np.stack([tops, release], axis=1),
            residuals=np.split(self._measured - self._heights(x)[0], self._ends),
            jacobian=self._change(x),
            rss=float(r @ r),
            parts=np.split(r**2, self._ends),
            information=J.T @ J,
        )

    def _split(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """All effects' parameters, and height and instant of each release."""
        k, e = self._moving, len(self._drops)
        instants = x[k + e :]
        if self._mode != "free":
            instants = np.full(e, instants[0] if self._instants else self._late)
        return np.concatenate([x[:k], self._theta[k:]]), x[k : k + e], instants

    def _heights(self, x: np.ndarray) -> tuple[np.ndarray, list[np.ndarray], float]:
        """Heights as read (rows of all drops), speeds per drop, and the scale of the reading."""
        values, tops, release = self._split(x)
        under, scale = unpack(self._names, values), 1.0
        tables: dict[float, np.ndarray] = {}
        for factor in self._rows_of:
            tables[factor], scale = table_of(under, self._duration, factor)
        read, speeds = np.empty(len(self._measured)), np.empty(len(self._measured))
        top, when = np.repeat(tops, self._counts), np.repeat(release, self._counts)
        for factor, rows in self._rows_of.items():
            h, speeds[rows] = height(self._times[rows], tables[factor], top[rows], when[rows])
            read[rows] = top[rows] + scale * (h - top[rows])
        return read, np.split(speeds, self._ends), scale

    def whitened(self, x: np.ndarray) -> np.ndarray:
        """Rows (N,) or (N, k) of all drops, each drop's as its noise is coloured."""
        if not self._white:
            return x
        return np.concatenate([w @ y for w, y in zip(self._white, np.split(x, self._ends), strict=True)])

    def _change(self, x: np.ndarray) -> np.ndarray:
        """Derivative of the heights: by finite differences over the effects, exact over the releases."""
        base, speeds, scale = self._heights(x)
        high = self.bounds[1]
        J = np.zeros((len(base), len(x)))
        for j in range(self._moving):
            step = 1e-5 * max(1.0, abs(x[j]))
            y = x.copy()
            y[j] += -step if x[j] + step > high[j] else step
            J[:, j] = (self._heights(y)[0] - base) / (y[j] - x[j])
        at, e = 0, len(self._drops)
        for i, d in enumerate(self._drops):
            rows = slice(at, at + len(d.t))
            J[rows, self._moving + i] = 1.0
            if self._instants:
                J[rows, self._moving + e + (i if self._mode == "free" else 0)] = scale * speeds[i]
            at += len(d.t)
        return J
