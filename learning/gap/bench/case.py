"""One benchmark case: what is hidden in it, drawn from a seed."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

KINDS = ("none", "recalibration", "single", "two", "outside")
STEPS = (0.0, 0.5)  # a recording is rounded to, over its noise
SHARES = (0.27, 0.06, 0.34, 0.17, 0.16)


@dataclass
class Truth:
    """What a case hides; written apart from the set and opened only for scoring.

    Attributes:
        kind: one of `KINDS`.
        effects: name, target and size (root mean square over that of the noise) of each, and `values`, the numbers
            the registry has for it ({} outside).
        intervals: [episode, t0, t1] where a localised effect acted.
        robot: or None.
        note: form of an effect outside the registry.
        apart: how far the truth is from the nearest other set of up to two effects [standard deviations], or None
            where it was not worked out.
        changes: [episode, t, mass before, mass after] where a payload changed within a recording.
    """

    system: str
    seed: int
    kind: str
    effects: list[dict[str, Any]] = field(default_factory=list)
    intervals: list[tuple[str, float, float]] = field(default_factory=list)
    robot: str | None = None
    note: str = ""
    apart: float | None = None
    changes: list[list[Any]] = field(default_factory=list)

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


def draw_kind(rng: np.random.Generator) -> str:
    """Which kind of case, with `SHARES`."""
    return str(rng.choice(KINDS, p=SHARES))


def draw_size(rng: np.random.Generator) -> float:
    """Size of an effect over the noise, 0.5 to 8, most between 0.5 and 4."""
    return float(np.exp(rng.uniform(np.log(0.5), np.log(8.0))))


def coloured(rng: np.random.Generator, n: int, dt: float, rms: float) -> np.ndarray:
    """Sensor noise (n,): part white, part with a memory of 5 to 150 ms, together `rms`."""
    return coloured_as(rng, n, dt, rms)[0]


def coloured_as(rng: np.random.Generator, n: int, dt: float, rms: float) -> tuple[np.ndarray, float, float]:
    """The same noise, with the memory [s] and the share of the variance of its slow part."""
    from scipy.signal import lfilter

    memory = float(np.exp(rng.uniform(np.log(0.005), np.log(0.15))))
    a = np.exp(-dt / memory)
    slow = lfilter([np.sqrt(1 - a * a)], [1.0, -a], rng.normal(size=n + 500))[500:]
    part = float(rng.uniform(0.2, 0.8))
    return rms * (np.sqrt(part) * slow + np.sqrt(1 - part) * rng.normal(size=n)), memory, part


def rounded(x: np.ndarray, step: float) -> np.ndarray:
    """What an instrument of this resolution shows of `x`; 0 for a perfect one."""
    return np.round(x / step) * step if step > 0.0 else x


def multisine(rng: np.random.Generator, t: np.ndarray, base: float, harmonics: int) -> np.ndarray:
    """Smooth random motion within +-1 (T,), at rest nowhere in particular."""
    x = np.zeros_like(t)
    for k in range(1, harmonics + 1):
        x += rng.normal() / k * np.sin(2 * np.pi * base * k * t + rng.uniform(0, 2 * np.pi))
    return x / max(np.abs(x).max(), 1e-9)


def moves(rng: np.random.Generator, t: np.ndarray, each: float) -> np.ndarray:
    """Point-to-point motion within +-1 with dwells (T,), minimum jerk."""
    x = np.zeros_like(t)
    level, at = rng.uniform(-1, 1), 0.0
    while at < t[-1]:
        goal = rng.uniform(-1, 1)
        move, rest = each * rng.uniform(0.6, 1.2), each * rng.uniform(0.05, 0.3)
        s = np.clip((t - at) / move, 0.0, 1.0)
        x = np.where(t >= at, level + (goal - level) * (10 * s**3 - 15 * s**4 + 6 * s**5), x)
        level, at = goal, at + move + rest
    return x
