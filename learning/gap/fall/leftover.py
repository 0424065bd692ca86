"""Whether something is left over that repeats from drop to drop: then what is missing is not in the registry.

Free forms are tried: a force that bends over the time since release slowly or quickly, one short push, one swing, and
a reading of the height that is bent; where the body was dropped with ballast too, also a drag that bends over the
speed.  (Released from rest at one mass, a body has one speed at a time, and a force over the one is a force over the
other.)  A push or a swing has one or two numbers besides its place and period, and is seen where fourteen pieces of a
force would drown it.  Effects and releases may give way to each form, and the noise's colour is asked anew, so that
neither what the registry can still take up nor slow noise is mistaken for a discovery.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline
from scipy.stats import f as fisher

from ....sim.effects.body.body_registry import BODY_EFFECTS
from .colour import Colour, grid, likelihood
from .drop import height
from .fit import RELEASE, Drop, DropFit, table_of

FORCES = (6, 14)  # pieces of the acceleration over the time since release
PUSHES = (8, 14, 20)  # of which one alone is a push
SWINGS = 16  # periods tried
READING = 8  # pieces of a bent reading over the height
DRAG = 6  # pieces of a drag over the speed


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


def repeating(fit: DropFit, drops: list[Drop]) -> Leftover:
    """Let each free form, the same in all drops, compete with noise; the surest is returned.

    Args:
        fit: the best set of effects.
        drops: what it was fitted to.
    """
    none = Leftover(energy=0.0, p_value=1.0, what="")
    if len(drops) < 2:
        return none  # one drop cannot tell a repeating force from slow noise
    falls = [Fall.of(d, r) for d, r in zip(drops, fit.releases[:, 1], strict=True)]
    colours = grid([d.t for d in drops])
    found = [_push(fit, falls, colours), _swing(fit, falls, colours)]  # fewest numbers first: they win ties
    found += [_force(fit, falls, pieces, colours) for pieces in FORCES]
    found.append(_reading(fit, _paths(fit, drops), colours))
    if len({f.factor for f in falls}) > 1:
        found.append(_drag(fit, falls, colours))
    best = min(found, key=lambda x: x.p_value)
    return Leftover(energy=best.energy, p_value=min(len(found) * best.p_value, 1.0), what=best.what)


@dataclass(frozen=True, kw_only=True)
class Fall:
    """A drop as a force sees it.  since: (T,) time since release [s]; factor: mass over that without ballast."""

    since: np.ndarray
    factor: float

    @classmethod
    def of(cls, drop: Drop, release: float) -> Fall:
        """The drop after its release [s]."""
        return cls(since=np.maximum(drop.t - release, 0.0), factor=drop.factor)


def _paths(fit: DropFit, drops: list[Drop]) -> list[np.ndarray]:
    """Heights the fit predicts, per drop [m]."""
    duration = max(float(d.t[-1]) for d in drops) + RELEASE + 0.1
    out = []
    for d, (top, when) in zip(drops, fit.releases, strict=True):
        table, scale = table_of(fit.values, duration, d.factor)
        out.append(top + scale * (height(d.t, table, top, when)[0] - top))
    return out


def _pieces(low: float, high: float, count: int) -> list[BSpline]:
    knots = np.concatenate([[low] * 3, np.linspace(low, high, count - 2), [high] * 3])
    return [BSpline.basis_element(knots[i : i + 5], extrapolate=False) for i in range(count)]


def _moments(falls: list[Fall]) -> np.ndarray:
    return np.linspace(0.0, max(float(f.since[-1]) for f in falls), 600)


def _ways(forces: np.ndarray, moments: np.ndarray, falls: list[Fall]) -> np.ndarray:
    """How far forces (M, k) at `moments` after release push each sample, (N, k)."""
    step = moments[1]
    way = np.cumsum(np.cumsum(forces, axis=0) * step, axis=0) * step
    return np.concatenate([_at(f.since, moments, way) / f.factor for f in falls])


def _at(since: np.ndarray, moments: np.ndarray, way: np.ndarray) -> np.ndarray:
    return np.stack([np.interp(since, moments, w) for w in way.T], axis=1)


def _bumps(moments: np.ndarray, count: int) -> np.ndarray:
    return np.stack([np.nan_to_num(b(moments)) for b in _pieces(0.0, float(moments[-1]), count)], axis=1)


def drag_ways(values: dict[str, dict[str, float]], falls: list[Fall]) -> np.ndarray:
    """How far pieces of a drag over the speed move each sample of falls under these effects, (N, DRAG)."""
    moments = _moments(falls)
    slope = {f.factor: _pull(values, moments, f.factor) for f in falls}
    fastest = max(float(v.max()) for v, _ in slope.values())
    ways = {}
    for factor, (speed, brake) in slope.items():
        force = np.stack([np.nan_to_num(b(speed)) for b in _pieces(0.0, fastest + 1e-6, DRAG)], axis=1) / factor
        # what a force adds to the speed, the drag of that speed takes away again
        fades = np.exp(np.minimum(np.cumsum(brake) * moments[1], 500.0))[:, None]
        ways[factor] = np.cumsum(np.cumsum(force * fades, axis=0) / fades, axis=0) * moments[1] ** 2
    return np.concatenate([_at(f.since, moments, ways[f.factor]) for f in falls])


def _pull(values: dict[str, dict[str, float]], moments: np.ndarray, factor: float) -> tuple[np.ndarray, np.ndarray]:
    """Speed [m/s] and how much faster it is braked per speed [1/s] at `moments` after release, (M,) each."""
    table, _ = table_of(values, float(moments[-1]) + 0.1, factor)
    speed = np.interp(moments, table[:, 0], table[:, 2])
    v = {n: BODY_EFFECTS[n].ballasted(x, factor) for n, x in values.items()}
    still, moving = v.get("quadratic_drag", {"coefficient": 0.0}), v.get("wind", {"coefficient": 0.0, "speed": 0.0})
    brake = v.get("linear_drag", {"rate": 0.0})["rate"] + 2.0 * still["coefficient"] * speed
    return speed, brake + 2.0 * moving["coefficient"] * np.abs(speed + moving["speed"])


def _drag(fit: DropFit, falls: list[Fall], colours: list[Colour]) -> Leftover:
    energy, p, _ = _pays(fit, drag_ways(fit.values, falls), colours)
    return Leftover(energy=energy, p_value=p, what="a drag that bends over the speed as none of the registry does")


def _force(fit: DropFit, falls: list[Fall], count: int, colours: list[Colour]) -> Leftover:
    moments = _moments(falls)
    bumps = _bumps(moments, count)
    energy, p, theta = _pays(fit, _ways(bumps, moments, falls), colours)
    when = float(moments[int(np.argmax(np.abs(bumps @ theta)))])
    return Leftover(
        energy=energy, p_value=p, what=f"a force that repeats from drop to drop, largest {when:.2f} s after release"
    )


def _push(fit: DropFit, falls: list[Fall], colours: list[Colour]) -> Leftover:
    """One short force, wherever and as long as it fits best."""
    moments = _moments(falls)
    bumps = np.concatenate([_bumps(moments, count) for count in PUSHES], axis=1)
    energy, p, k = _best_of(fit, _ways(bumps, moments, falls), 1, colours)
    when = float(moments[int(np.argmax(bumps[:, k]))])
    return Leftover(energy=energy, p_value=p, what=f"a short push {when:.2f} s after release, the same in all drops")


def _swing(fit: DropFit, falls: list[Fall], colours: list[Colour]) -> Leftover:
    """One force that swings, of whatever period fits best."""
    moments = _moments(falls)
    end = float(moments[-1])
    turns = 2.0 * np.pi * np.linspace(0.75, 0.5 * SWINGS + 0.25, SWINGS) / end
    waves = np.stack([f(w * moments) for w in turns for f in (np.sin, np.cos)], axis=1)
    energy, p, k = _best_of(fit, _ways(waves, moments, falls), 2, colours)
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
