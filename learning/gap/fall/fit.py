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
    parameters = [p for name in names for p in BODY_EFFECTS[name].parameters]
    theta = np.array([START[p.name] for p in parameters]) if start is None else np.asarray(start, dtype=float)
    moving, e = 0 if start is not None else len(parameters), len(drops)
    instants = {"together": 0, "late": 0 if late is not None else 1, "free": e}[mode]
    duration = max(float(d.t[-1]) for d in drops) + RELEASE + 0.1
    times, measured = (np.concatenate(x) for x in ([d.t for d in drops], [d.h for d in drops]))
    counts = [len(d.t) for d in drops]
    ends = np.cumsum(counts)[:-1]
    factor_of = np.repeat([d.factor for d in drops], counts)
    rows_of = {f: np.flatnonzero(factor_of == f) for f in dict.fromkeys(factor_of.tolist())}
    first = np.concatenate([theta[:moving], [d.h[:3].mean() for d in drops], np.zeros(instants)])
    low = np.concatenate([[p.lower for p in parameters][:moving], [-np.inf] * e, [-RELEASE] * instants])
    high = np.concatenate([[p.upper for p in parameters][:moving], [np.inf] * e, [RELEASE] * instants])

    def split(x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        tail = x[moving + e :]
        release = tail if mode == "free" else np.full(e, tail[0] if instants else (late or 0.0))
        return np.concatenate([x[:moving], theta[moving:]]), x[moving : moving + e], release

    def model(x: np.ndarray) -> tuple[np.ndarray, list[np.ndarray], float]:
        values, tops, release = split(x)
        under, scale = unpack(names, values), 1.0
        tables: dict[float, np.ndarray] = {}
        for factor in rows_of:
            tables[factor], scale = table_of(under, duration, factor)
        read, speeds = np.empty(len(measured)), np.empty(len(measured))
        top, when = np.repeat(tops, counts), np.repeat(release, counts)
        for factor, rows in rows_of.items():
            h, speeds[rows] = height(times[rows], tables[factor], top[rows], when[rows])
            read[rows] = top[rows] + scale * (h - top[rows])
        return read, np.split(speeds, ends), scale

    white = [d.white for d in drops if d.white is not None]

    def whitened(x: np.ndarray) -> np.ndarray:
        return np.concatenate([w @ y for w, y in zip(white, np.split(x, ends), strict=True)]) if white else x

    def residual(x: np.ndarray) -> np.ndarray:
        return whitened(model(x)[0] - measured)

    def jacobian(x: np.ndarray) -> np.ndarray:
        return whitened(change(x))

    def change(x: np.ndarray) -> np.ndarray:
        base, speeds, scale = model(x)
        J = np.zeros((len(base), len(x)))
        for j in range(moving):
            step = 1e-5 * max(1.0, abs(x[j]))
            y = x.copy()
            y[j] += -step if x[j] + step > high[j] else step
            J[:, j] = (model(y)[0] - base) / (y[j] - x[j])
        at = 0
        for i, d in enumerate(drops):
            rows = slice(at, at + len(d.t))
            J[rows, moving + i] = 1.0
            if instants:
                J[rows, moving + e + (i if mode == "free" else 0)] = scale * speeds[i]
            at += len(d.t)
        return J

    if near is not None:
        instant = {"together": [], "late": near.releases[:1, 1][:instants], "free": near.releases[:, 1]}[mode]
        first = np.concatenate([near.theta[:moving], near.releases[:, 0], instant])
    first[:moving] = np.clip(first[:moving], low[:moving] + 1e-9, high[:moving] - 1e-9)
    solved = least_squares(
        residual,
        first,
        jac=jacobian,  # pyright: ignore[reportArgumentType] - scipy's stubs know strings only
        bounds=(low, high),
        x_scale="jac",
        max_nfev=60,
    )
    r, J = residual(solved.x), jacobian(solved.x)
    values, tops, release = split(solved.x)
    return DropFit(
        names=names,
        mode=mode,
        values=unpack(names, values),
        theta=values,
        releases=np.stack([tops, release], axis=1),
        residuals=np.split(measured - model(solved.x)[0], ends),
        jacobian=change(solved.x),
        rss=float(r @ r),
        parts=np.split(r**2, ends),
        information=J.T @ J,
    )
