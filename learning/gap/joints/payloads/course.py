"""The course of a recording: which of some loads acts when, and the row at which one gives way to another."""

from __future__ import annotations

import numpy as np

from ..log import JointLog
from ..rigid import During, Spell

LEAST = 1.5  # [s] that something is carried; what is carried more briefly is the change itself
Span = tuple[int, int, int]  # which payload, first row, row after the last


def during_of(state: int, every: list[list[Span]], logs: list[JointLog], last: bool) -> During:
    """When one payload is carried, from rows to seconds."""
    spells: dict[str, tuple[Spell, ...]] = {}
    for log, mine in zip(logs, every, strict=True):
        t = log.t[log.inner]
        edge = [*t, np.inf]
        spells[log.name] = tuple((-np.inf if a == 0 else float(t[a]), float(edge[b])) for s, a, b in mine if s == state)
    return During(spells=spells, last=last)


def lengths(every: list[list[Span]], logs: list[JointLog], state: int) -> list[float]:
    """How long one payload is carried each time [s]."""
    return [(b - a) * log.dt for log, spans in zip(logs, every, strict=True) for s, a, b in spans if s == state]


def told(log: JointLog, left: np.ndarray, loads: np.ndarray, weight: np.ndarray, price: float) -> list[Span]:
    """Which of some loads acts when in one recording: the likeliest course, every change for a price.

    What is over within `LEAST` is part of a change.

    Args:
        log: of the recording.
        left: (T, C) residual without any of the loads.
        loads: (K, T, C) what each of them would be.
        weight: (C,) of the channels.
        price: of a change.
    """
    cost = np.einsum("ktc,c->tk", (left[None] - loads) ** 2, weight)
    best, came = np.zeros(cost.shape[1]), np.zeros(cost.shape, dtype=int)
    for i, now in enumerate(cost):
        k = int(np.argmin(best))
        changed = best[k] + price < best
        came[i] = np.where(changed, k, np.arange(len(best)))
        best = np.where(changed, best[k] + price, best) + now
    state = int(np.argmin(best))
    out: list[Span] = []
    stop = len(cost)
    for i in range(len(cost) - 1, -1, -1):
        before = int(came[i, state])
        if i == 0 or before != state:
            out.append((state, i, stop))
            state, stop = before, i
    return _placed(log, _lasting(out[::-1], log.dt), left, loads, weight)


def _lasting(spans: list[Span], dt: float) -> list[Span]:
    """Spans without those that are over too soon, in whose place what was before goes on, or what comes at first."""
    out: list[Span] = []
    for state, a, b in spans:
        if out and (out[-1][0] == state or (b - a) * dt < LEAST):
            out[-1] = (out[-1][0], out[-1][1], b)
        elif out and (out[0][2] - out[0][1]) * dt < LEAST:  # only the first can be that short
            out[0] = (state, out[0][1], b)
        else:
            out.append((state, a, b))
    return out


def _placed(log: JointLog, spans: list[Span], left: np.ndarray, loads: np.ndarray, weight: np.ndarray) -> list[Span]:
    """Every change moved to the row that suits it best once it is as smooth as the filters make it."""
    rows, reach = len(left), int(np.ceil(1.0 / (log.cutoff * log.dt)))
    middle = len(log.t) // 2
    rise = log.shared((np.arange(len(log.t)) >= middle).astype(float), sharp=True)
    out = list(spans)
    for k in range(len(out) - 1):
        (before, start, at), (after, _, stop) = out[k], out[k + 1]
        near = np.arange(max(start, at - 2 * reach), min(stop, at + 2 * reach))

        def cost(row: int, near: np.ndarray = near, before: int = before, after: int = after) -> float:
            part = rise[np.clip(near - row + middle - log.trim, 0, rows - 1)][:, None]
            missed = left[near] - (1.0 - part) * loads[before, near] - part * loads[after, near]
            return float(np.sum(missed**2 @ weight))

        best = min(range(max(start + 1, at - reach), min(stop, at + reach)), key=cost, default=at)
        out[k], out[k + 1] = (before, start, best), (after, best, stop)
    return out
