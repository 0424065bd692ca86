"""Loads of hidden effects on one joint, written from the physics for the generator alone."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np


@dataclass
class Trace:
    """Motion of one joint (T,) and its rigid load."""

    t: np.ndarray
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    u: np.ndarray


@dataclass
class Drawn:
    """A hidden effect up to its size.

    Attributes:
        load: (T,) per episode, at a size of 1.
        linear: the registry's parameters at a size of 1; {} outside the registry.
        fixed: those that do not depend on the size.
    """

    load: list[np.ndarray]
    linear: dict[str, float] = field(default_factory=dict)
    fixed: dict[str, float] = field(default_factory=dict)

    def values(self, size: float) -> dict[str, float]:
        """The registry's parameters at a size."""
        return {**{k: float(size * v) for k, v in self.linear.items()}, **{k: float(v) for k, v in self.fixed.items()}}


def shape_of(name: str, m: list[Trace], rng: np.random.Generator) -> Drawn:
    """Load of an effect per episode, up to a positive factor, and what the registry would call it.

    Raises:
        KeyError: no such effect.
    """
    drawn = _SHAPES[name](m, rng)
    return drawn if isinstance(drawn, Drawn) else Drawn(drawn)


def _viscous(m, rng):
    return Drawn([x.v for x in m], {"coefficient": 1.0})


def _sign(v, eps=1e-4):
    return np.sign(v) * (np.abs(v) > eps * np.abs(v).max())


def _coulomb(m, rng):
    return Drawn([_sign(x.v) for x in m], {"level": 1.0})


def _asymmetric(m, rng):
    a, b = 1.0, rng.uniform(0.0, 0.45)
    if rng.random() < 0.5:
        a, b = b, a
    load = [np.where(x.v > 0, a, b) * _sign(x.v) for x in m]
    return Drawn(load, {"forward": a, "backward": b})


def _stribeck(m, rng):
    vs = rng.uniform(0.08, 0.3) * np.quantile(np.abs(np.concatenate([x.v for x in m])), 0.95)
    ratio = rng.uniform(0.8, 2.5)
    load = []
    for x in m:
        rng.random()  # one draw an episode, so that the draws that follow stay the same
        load.append((1.0 + ratio * np.exp(-((x.v / vs) ** 2))) * _sign(x.v))
    return Drawn(load, {"level": 1.0, "excess": ratio}, {"speed": vs})


def _load(m, rng):
    return Drawn([np.abs(x.u) * _sign(x.v) for x in m], {"ratio": 1.0})


def _offset(m, rng):
    s = rng.choice([-1.0, 1.0])
    return Drawn([s * np.ones_like(x.v) for x in m], {"value": s})


def _gain(m, rng):
    s = rng.choice([-1.0, 1.0])
    return Drawn([s * x.u for x in m], {"fraction": s})


def _delay(m, rng):
    # the caller scales this to the wanted size; lags stay far below the motion's period
    return [np.interp(x.t - 1e-3, x.t, x.u) - x.u for x in m]


def _backlash(m, rng):
    reach = np.ptp(np.concatenate([x.q for x in m]))
    gap = reach * np.exp(rng.uniform(np.log(0.004), np.log(0.05)))
    out = []
    for x in m:
        way = _sign(x.v)
        moving = np.flatnonzero(way)
        # a joint at rest has not turned: the last way it went counts until it goes another
        turn = moving[1:][np.diff(way[moving]) != 0]
        load = np.zeros_like(x.u)
        for i, start in enumerate(turn):
            stop = turn[i + 1] if i + 1 < len(turn) else len(x.q)
            inside = np.abs(x.q[start:stop] - x.q[start]) < gap
            k = np.flatnonzero(~inside)
            n = k[0] if len(k) else stop - start
            load[start : start + n] = -x.u[start : start + n]
        out.append(load)
    return Drawn(out, {"fraction": 1.0}, {"width": gap})


def _armature(m, rng):
    return Drawn([x.a for x in m], {"inertia": 1.0})


def _spring(m, rng):
    q = np.concatenate([x.q for x in m])
    rest = rng.uniform(q.min(), q.max())
    return Drawn([x.q - rest for x in m], {"stiffness": 1.0, "preload": rest})


def _contact(m, rng):
    q = np.concatenate([x.q for x in m])
    part = rng.uniform(0.06, 0.25)
    if rng.random() < 0.5:
        wall = np.quantile(q, 1 - part)
        return Drawn([np.maximum(x.q - wall, 0.0) for x in m], {"stiffness": 1.0}, {"threshold": wall})
    wall = np.quantile(q, part)
    return Drawn([np.minimum(x.q - wall, 0.0) for x in m], {"stiffness": 1.0}, {"threshold": wall})


# outside the registry
def _cogging(m, rng):
    reach = np.ptp(np.concatenate([x.q for x in m]))
    k = 2 * np.pi * rng.uniform(5, 20) / reach
    p = rng.uniform(0, 6)
    return [np.sin(k * x.q + p) for x in m]


def _vibration(m, rng):
    f = rng.uniform(0.7, 3.0)
    return [np.sin(2 * np.pi * f * x.t + rng.uniform(0, 6)) for x in m]


def _warming(m, rng):
    tau = rng.uniform(0.3, 0.8) * m[0].t[-1]
    return [np.exp(-(x.t - x.t[0]) / tau) * x.v for x in m]


def _place_friction(m, rng):
    q = np.concatenate([x.q for x in m])
    c, w = rng.uniform(q.min(), q.max()), 0.12 * np.ptp(q)
    return [np.exp(-(((x.q - c) / w) ** 2)) * _sign(x.v) for x in m]


def _centre(m, rng):
    q = np.concatenate([x.q for x in m])
    c, w = np.quantile(q, rng.uniform(0.3, 0.7)), 0.15 * np.ptp(q)
    return [np.exp(-(((x.q - c) / w) ** 2)) for x in m]


def _wind_up(m, rng):
    reach = 0.1 * np.ptp(np.concatenate([x.q for x in m]))
    out = []
    for x in m:  # Dahl: friction that builds up over a distance
        z = np.zeros_like(x.q)
        for i in range(1, len(z)):
            d = x.q[i] - x.q[i - 1]
            z[i] = np.clip(z[i - 1] + (d - abs(d) * z[i - 1]) / reach, -1, 1)
        out.append(z)
    return out


_SHAPES = {
    "viscous_friction": _viscous,
    "coulomb_friction": _coulomb,
    "asymmetric_friction": _asymmetric,
    "stribeck_friction": _stribeck,
    "load_friction": _load,
    "offset": _offset,
    "gain_error": _gain,
    "delay": _delay,
    "backlash": _backlash,
    "armature": _armature,
    "spring": _spring,
    "contact": _contact,
    "cogging": _cogging,
    "vibration": _vibration,
    "warming": _warming,
    "place_friction": _place_friction,
    "centre_pull": _centre,
    "wind_up": _wind_up,
}
INSIDE = tuple(k for k in list(_SHAPES)[:12])
OUTSIDE = tuple(k for k in list(_SHAPES)[12:])
