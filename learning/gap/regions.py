"""In which state the disagreement sits, and when: bins of the state, and intervals in time."""

from __future__ import annotations

import numpy as np

from .measurement import Phase

LIFT = 1.6  # a state counts as the place when its mean square exceeds the overall one by this factor


def state_region(excess: np.ndarray, q: np.ndarray, v: np.ndarray, a: np.ndarray, load: np.ndarray, dt: float) -> str:
    """The state in which squared disagreement is most concentrated.

    Args:
        excess: (T,) squared disagreement.
        q: (T,) position.
        v: (T,) velocity.
        a: (T,) acceleration.
        load: (T,) load of the model.
        dt: [s].

    Returns:
        One of `reversal`, `low speed`, `high speed`, `high load`, `high acceleration`, `upper end of range`,
        `lower end of range`, `forward motion`, `backward motion`, `everywhere`.
    """
    speed = np.abs(v)
    fast = np.quantile(speed, 0.95) + 1e-12
    turn = np.zeros(len(v), dtype=bool)
    width = max(1, int(0.08 / dt))
    for i in np.flatnonzero(np.diff(np.sign(v)) != 0):
        turn[max(0, i - width) : i + width] = True
    top, bottom = np.quantile(q, 0.85), np.quantile(q, 0.15)
    heavy = np.quantile(np.abs(load), 0.85)
    sharp = np.quantile(np.abs(a), 0.85)
    bins = {
        "reversal": turn,
        "low speed": speed < 0.15 * fast,
        "high speed": speed > 0.75 * fast,
        "high load": np.abs(load) >= heavy,
        "high acceleration": np.abs(a) >= sharp,
        "upper end of range": q >= top,
        "lower end of range": q <= bottom,
        "forward motion": v > 0.05 * fast,
        "backward motion": v < -0.05 * fast,
    }
    total = excess.mean() + 1e-30
    lifts = {name: excess[rows].mean() / total for name, rows in bins.items() if 0.02 < rows.mean() < 0.7}
    best = max(lifts, key=lambda k: lifts[k], default="everywhere")
    return best if lifts.get(best, 0.0) > LIFT else "everywhere"


def intervals(active: np.ndarray, t: np.ndarray, join: float, shortest: float) -> list[tuple[float, float]]:
    """Stretches of time where `active`, with gaps up to `join` [s] closed and those under `shortest` [s] left out."""
    edges = np.diff(np.concatenate([[0], active.astype(int), [0]]))
    out: list[list[float]] = []
    for i, j in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1, strict=True):
        if out and t[i] - out[-1][1] <= join:
            out[-1][1] = float(t[j])
        else:
            out.append([float(t[i]), float(t[j])])
    return [(a, b) for a, b in out if b - a >= shortest]


def scan(energy: np.ndarray, t: np.ndarray, floor: float, join: float) -> list[tuple[float, float]]:
    """Intervals in which mean square disagreement stands above the floor, by change points (ruptures).

    Args:
        energy: (T,) squared disagreement.
        t: [s].
        floor: mean square of the noise.
        join: gaps up to this are closed [s].
    """
    import ruptures

    step = max(1, len(energy) // 400)
    n = len(energy) // step
    coarse = energy[: n * step].reshape(n, step).mean(axis=1)
    level = np.sqrt(coarse)[:, None] / (np.sqrt(floor) + 1e-30)
    cuts = (
        ruptures.KernelCPD(kernel="linear", min_size=2)
        .fit(level)
        .predict(pen=4.0 * np.log(n) * max(float(np.median(np.abs(np.diff(level[:, 0])))) ** 2, 1e-6))
    )
    active = np.zeros(len(energy), dtype=bool)
    cuts = list(cuts or [n])
    for a, b in zip([0, *cuts[:-1]], cuts, strict=True):
        if coarse[a:b].mean() > 2.0 * floor:
            active[a * step : b * step] = True
    return intervals(active, t, join, 0.0)


def phase_of(phases: tuple[Phase, ...], t0: float, t1: float) -> str:
    """Name of the phase that covers most of an interval, or ""."""
    shared = {p.name: min(t1, p.t1) - max(t0, p.t0) for p in phases}
    best = max(shared, key=lambda k: shared[k], default="")
    return best if best and shared[best] > 0 else ""
