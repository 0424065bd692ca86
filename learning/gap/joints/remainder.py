"""What is left after the named effects: still a function of the state or of time, or only noise?

Each channel's leftover is predicted out of sample (each stretch from the others) by smooth functions of the state, by
waves in position (cogging, eccentric gears) and by waves and slow drifts in time (fans, vibration, warming up).  What
such a prediction removes is a missing effect the bank has no name for.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

from .generic import clock_columns, generic_columns, scales
from .gram import fold_edges
from .log import JointLog

RIDGES = (1e-3, 1e-1, 3.0)
WAVES = 60
FOLDS = 6


@dataclass(frozen=True, kw_only=True)
class Remainder:
    """Leftover of one channel.

    Attributes:
        channel: which.
        energy: mean square predicted out of sample, in the squared unit of the load.
        p_value: chance that noise alone is predicted this well, over all kinds tried.
        kind: `state`, `position wave`, `time wave` or `drift`.
        detail: period or form, for the reader.
    """

    channel: int
    energy: float
    p_value: float
    kind: str
    detail: str


def leftover(logs: list[JointLog], left: list[np.ndarray], wide: list[np.ndarray], channel: int) -> Remainder:
    """The best out-of-sample prediction of one channel's leftover, over all kinds.

    Args:
        logs: the logs fitted to.
        left: (T_inner, C) per log, residual after the named effects.
        wide: the same without the shared filter, for waves in time beyond the motion's bandwidth.
        channel: which joint.
    """
    y = np.concatenate([x[:, channel] for x in left])
    edges = fold_edges(logs, FOLDS)
    fold = np.concatenate([np.concatenate([np.full(b - a, f) for f, a, b in parts]) for parts in edges])
    scale = scales(logs)
    kinds = {"state": (np.concatenate([generic_columns(log, channel, scale) for log in logs]), "a function of the state"),
             "drift": (np.concatenate([clock_columns(log) for log in logs]), "slow in time")}
    q = np.concatenate([log.q[log.inner, channel] for log in logs])
    reach = max(float(np.ptp(q)), 1e-9)
    k = _loudest(y, q, np.linspace(2.0, 2.0 * WAVES, 4 * WAVES) * np.pi / reach)
    kinds["position wave"] = (_waves(q, k), f"period {2 * np.pi / k:.4g} in position")
    clock = np.concatenate([log.t[log.inner] for log in logs])
    span = max(float(log.t[-1] - log.t[0]) for log in logs)
    loud = np.concatenate([x[:, channel] for x in wide])
    f = _loudest(loud, clock, 2 * np.pi * np.arange(2.0 / span, 0.4 / max(log.dt for log in logs), 0.4 / span))
    phases = [np.where(np.concatenate([np.full(len(log.t[log.inner]), i == j) for j, log in enumerate(logs)])[:, None],
                       _waves(clock, f), 0.0) for i in range(len(logs))]  # its own phase in each episode
    kinds["time wave"] = (np.concatenate(phases, axis=1), f"period {2 * np.pi / f:.4g} s")
    results = []
    for kind, (X, detail) in kinds.items():
        within = kind in ("time wave", "drift")
        gain, p = _predict(X, loud if kind == "time wave" else y, _interleaved(fold, edges) if within else fold)
        results.append(Remainder(channel=channel, energy=max(gain, 0.0), p_value=min(1.0, len(kinds) * p), kind=kind, detail=detail))
    sure = [r for r in results if r.p_value < 0.01] or results
    return max(sure, key=lambda r: r.energy)


def _interleaved(fold: np.ndarray, edges) -> np.ndarray:
    """Folds that cut every episode, for kinds whose phase is each episode's own."""
    out, at = np.empty_like(fold), 0
    for parts in edges:
        n = sum(b - a for _, a, b in parts)
        out[at:at + n] = (np.arange(n) * 2 * FOLDS // max(n, 1)) % FOLDS
        at += n
    return out


def _waves(x: np.ndarray, k: float) -> np.ndarray:
    return np.stack([np.sin(k * x), np.cos(k * x), np.sin(2 * k * x), np.cos(2 * k * x)], axis=1)


def _loudest(y: np.ndarray, x: np.ndarray, wavenumbers: np.ndarray) -> float:
    thin = slice(None, None, max(1, len(y) // 4000))
    a, b = y[thin] - y.mean(), x[thin]
    power = np.abs(np.exp(-1j * np.outer(wavenumbers, b)) @ a)
    return float(wavenumbers[int(np.argmax(power))])


def _predict(X: np.ndarray, y: np.ndarray, fold: np.ndarray) -> tuple[float, float]:
    """Mean square removed out of sample with the best ridge, and its p-value over blocks."""
    X = X / (np.sqrt(np.mean(X**2, axis=0)) + 1e-12)
    every = range(int(fold.max()) + 1)
    G = np.array([X[fold == f].T @ X[fold == f] for f in every])
    b = np.array([X[fold == f].T @ y[fold == f] for f in every])
    best = (-np.inf, 1.0)
    for ridge in RIDGES:
        gain = np.zeros(len(y))
        for f in every:
            theta = np.linalg.solve(G.sum(axis=0) - G[f] + ridge * len(y) / 50.0 * np.eye(X.shape[1]), b.sum(axis=0) - b[f])
            rows = fold == f
            gain[rows] = y[rows] ** 2 - (y[rows] - X[rows] @ theta) ** 2
        blocks = np.array([g.mean() for g in np.array_split(gain, 24)])
        spread = blocks.std(ddof=1) / np.sqrt(len(blocks)) + 1e-30
        p = float(student.sf(blocks.mean() / spread, len(blocks) - 1))
        if gain.mean() > best[0]:
            best = (float(gain.mean()), p)
    return best
