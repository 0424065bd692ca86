"""What is left after the named effects: still a function of the state or of time, or only noise?

Each channel's leftover is predicted out of sample (each stretch from the others) by smooth functions of the state, by
waves in position (cogging, eccentric gears), by what another joint does (a cable that runs along both, coupled gears),
and by waves and slow drifts in time (fans, vibration, warming up).  What such a prediction removes is a missing effect
the registry has no name for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import f as fisher
from scipy.stats import t as student

from ..block import Block
from ..gram import fold_edges
from ..log import JointLog
from ..noise import autocorrelation, estimate_noise
from .generic import clock_columns, generic_columns, other_columns, past_columns, place_columns, scales

RIDGES = (1e-3, 1e-1, 3.0)
WAVES = 60
FOLDS = 6
SHIFTS = 40
STRETCHES = 24
IMITATED = 1e-6  # part of a feature's energy below which the named effects are the same thing
REPEATS = 0.05  # p-value of the gain over stretches above which it does not repeat
ALIKE = 3  # neighbouring stretches that may be alike
TRIED = {"position wave": 100, "time wave": 20, "other joint": 6}  # the period, the joint was picked from the same data


@dataclass(frozen=True, kw_only=True)
class Remainder:
    """Leftover of one channel.

    Attributes:
        channel: which.
        energy: mean square predicted out of sample, in the squared unit of the load.
        base: mean square it was predicted from.
        p_value: chance that noise alone is predicted this well, over all kinds tried.
        kind: `state`, `place`, `past`, `drift`, `other joint`, `position wave` or `time wave`.
        detail: period or form, for the reader.
    """

    channel: int
    energy: float
    base: float
    p_value: float
    kind: str
    detail: str


def leftover(
    logs: list[JointLog],
    left: list[np.ndarray],
    wide: list[np.ndarray],
    channel: int,
    blocks: Sequence[Block] = (),
) -> Remainder:
    """The best out-of-sample prediction of one channel's leftover, over all kinds.

    Args:
        logs: the logs fitted to.
        left: (T_inner, C) per log, residual after the named effects.
        wide: the same without the shared filter, for waves in time beyond the motion's bandwidth.
        channel: which joint.
        blocks: the named effects, which give way to a memory of the way travelled: friction that builds up over a
            distance is half a spring and half dry friction, and little of it is left beside them.
    """
    y = np.concatenate([x[:, channel] for x in left])
    loud = np.concatenate([x[:, channel] for x in wide])
    edges = fold_edges(logs, FOLDS)
    fold = np.concatenate([np.concatenate([np.full(b - a, f) for f, a, b in parts]) for parts in edges])
    kinds = {
        **_state_kinds(logs, channel),
        **_other_kind(logs, y, channel),
        "position wave": _position_wave(logs, y, channel),
        "time wave": _time_wave(logs, wide, channel),
    }
    results = []
    for kind, (X, detail) in kinds.items():
        within = kind in ("time wave", "drift")
        target = loud if kind == "time wave" else y
        gain, p = _predict(X, target, _interleaved(fold, edges) if within else fold, within)
        if kind == "drift":
            gain, p = _wald(X, y, [len(x) for x in left])
        elif kind == "past":
            gain, p = _wald(*_giving_way(blocks, logs, channel, X, y), [len(x) for x in left])
        elif kind == "other joint":
            # few columns, so what noise does in sample is known; a shift in time leaves slow joints alike
            removed, p = _wald(X, y, [len(x) for x in left])
            gain = min(gain, removed)
        results.append(
            Remainder(
                channel=channel,
                energy=max(gain, 0.0),
                base=float(np.mean(target**2)),
                p_value=min(1.0, len(kinds) * TRIED.get(kind, 1) * p),
                kind=kind,
                detail=detail,
            )
        )
    significant = [r for r in results if r.p_value < 0.01] or results
    return max(significant, key=lambda r: r.energy / max(r.base, 1e-30))


def _giving_way(
    blocks: Sequence[Block], logs: list[JointLog], channel: int, X: np.ndarray, y: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Features (T_inner over all logs, p) and leftover without what the named effects can take of them."""
    mine = [b for b in blocks if channel in b.channels]
    if not mine:
        return X, y
    columns = [[b.build(log)[:, b.channels.index(channel), :] for b in mine] for log in logs]
    basis = np.concatenate([np.concatenate(parts, axis=1) for parts in columns])
    table = np.column_stack([X, y])
    left = table - basis @ np.linalg.lstsq(basis, table, rcond=1e-10)[0]
    own = np.sum(left**2, axis=0) > IMITATED * np.sum(table**2, axis=0)
    return left[:, :-1] * own[:-1], left[:, -1]


Kind = tuple[np.ndarray, str]  # (T_inner over all logs, p) features, and the form for the reader


def _state_kinds(logs: list[JointLog], channel: int) -> dict[str, Kind]:
    """Features that need no period to be found first."""
    scale = scales(logs)
    return {
        "state": (np.concatenate([generic_columns(log, channel, scale) for log in logs]), "a function of the state"),
        "place": (
            np.concatenate([place_columns(log, channel, scale) for log in logs]),
            "bound to a place, or friction that differs from place to place",
        ),
        "past": (np.concatenate([past_columns(log, channel) for log in logs]), "a memory of the way travelled"),
        "drift": (
            np.concatenate([clock_columns(log, channel) for log in logs]),
            "slow in time, alone or with the state",
        ),
    }


def _other_kind(logs: list[JointLog], y: np.ndarray, channel: int) -> dict[str, Kind]:
    """What that other joint of an arm does which tells most of `y` (T_inner over all logs,); none for an axis."""
    scale, found = scales(logs), []
    for j in range(logs[0].q.shape[1]):
        if j != channel:
            X = np.concatenate([other_columns(log, channel, j, scale) for log in logs])
            left = y - X @ np.linalg.lstsq(X, y, rcond=1e-8)[0]
            found.append((float(left @ left), j, X))
    if not found:
        return {}
    _, j, X = min(found, key=lambda x: x[0])
    return {"other joint": (X, f"bound to what another joint does (q{j + 1})")}


def _position_wave(logs: list[JointLog], y: np.ndarray, channel: int) -> Kind:
    """Waves in position, as cogging makes them, with the loudest period of `y` (T_inner over all logs,)."""
    q = np.concatenate([log.q[log.inner, channel] for log in logs])
    reach = max(float(np.ptp(q)), 1e-9)
    k = _loudest([(y, q)], 2.0 * np.pi / reach, 2.0 * WAVES * np.pi / reach)
    return _waves(q, k), f"period {2 * np.pi / k:.4g} in position"


def _time_wave(logs: list[JointLog], wide: list[np.ndarray], channel: int) -> Kind:
    """Waves in time with the loudest period of `wide`, with a phase of their own in each episode."""
    clock = np.concatenate([log.t[log.inner] for log in logs])
    span = max(float(log.t[-1] - log.t[0]) for log in logs)
    top = 2 * np.pi * 0.4 / max(log.dt for log in logs)
    f = _loudest([(x[:, channel], log.t[log.inner]) for x, log in zip(wide, logs, strict=True)], 4 * np.pi / span, top)
    episode = np.repeat(np.arange(len(logs)), [len(log.t[log.inner]) for log in logs])
    waves = _waves(clock, f)
    phases = [np.where((episode == i)[:, None], waves, 0.0) for i in range(len(logs))]
    return np.concatenate(phases, axis=1), f"period {2 * np.pi / f:.4g} s"


def _wald(X: np.ndarray, y: np.ndarray, lengths: list[int]) -> tuple[float, float]:
    """Mean square a few columns remove in sample, less what chance removes, and its p-value under coloured noise."""
    X = X / (np.sqrt(np.mean(X**2, axis=0)) + 1e-12)
    u, s, _ = np.linalg.svd(X, full_matrices=False)
    u = u[:, s > 1e-4 * s[0]]
    if not u.shape[1]:
        return 0.0, 1.0
    after = y - u @ (u.T @ y)
    ends = np.cumsum(lengths)[:-1]
    parts = [x[:, None] for x in np.split(after, ends)]
    noise = estimate_noise(parts, "residual")
    acf = autocorrelation(np.split(u, ends), noise.acf.shape[1])
    widening = float(noise.widening(acf, 0).max())
    before, rest, k = float(y @ y), float(after @ after), u.shape[1]
    removed = (before - rest * (1.0 + k * widening / len(y))) / len(y)
    free = len(y) / widening - k  # coloured rows are worth fewer, and a short log's noise is itself not well known
    if free < 1.0:
        return removed, 1.0
    return removed, float(fisher.sf((before - rest) / k / (rest / free + 1e-30), k, free))


def _interleaved(fold: np.ndarray, edges) -> np.ndarray:
    """Folds that cut every episode, for kinds whose phase is each episode's own."""
    out, at = np.empty_like(fold), 0
    for parts in edges:
        n = sum(b - a for _, a, b in parts)
        out[at : at + n] = (np.arange(n) * 2 * FOLDS // max(n, 1)) % FOLDS
        at += n
    return out


def _waves(x: np.ndarray, k: float) -> np.ndarray:
    return np.stack([np.sin(k * x), np.cos(k * x), np.sin(2 * k * x), np.cos(2 * k * x)], axis=1)


def _loudest(parts: list[tuple[np.ndarray, np.ndarray]], low: float, high: float) -> float:
    """Wavenumber between two bounds at which series over a coordinate have most power, phases free per part.

    Args:
        parts: (values, coordinate) pairs; the coordinate need not be uniform.
        low: smallest wavenumber [rad per unit of the coordinate].
        high: largest one.
    """
    start = min(float(x.min()) for _, x in parts)
    reach = max(max(float(x.max()) for _, x in parts) - start, 1e-9)
    bins = int(np.clip(2 ** np.ceil(np.log2(2.0 * reach * high / np.pi)), 256, 16384))
    power = np.zeros(2 * bins + 1)
    for y, x in parts:
        cell = np.minimum(((x - start) / reach * bins).astype(int), bins - 1)
        power += np.abs(np.fft.rfft(np.bincount(cell, weights=y - y.mean(), minlength=bins), n=4 * bins)) ** 2
    k = 2 * np.pi * np.arange(2 * bins + 1) / (4.0 * reach)
    inside = (k >= low) & (k <= high)
    return float(k[inside][int(np.argmax(power[inside]))]) if inside.any() else low


def _predict(X: np.ndarray, y: np.ndarray, fold: np.ndarray, within: bool) -> tuple[float, float]:
    """Mean square removed out of sample with the best ridge, and its p-value.

    Two nulls.  The leftover shifted in time against the features is as coloured as before but unrelated to them; waves
    and drifts in time survive a shift, so for them the gain must be there in stretch after stretch instead.
    """
    X = X / (np.sqrt(np.mean(X**2, axis=0)) + 1e-12)
    parts = [X[fold == f] for f in range(int(fold.max()) + 1)]
    rows = [np.flatnonzero(fold == f) for f in range(len(parts))]
    G = np.array([x.T @ x for x in parts])
    best: tuple[float, float] = (-np.inf, 1.0)
    kept: list[np.ndarray] = []
    for ridge in RIDGES:
        inverse = [np.linalg.inv(G.sum(axis=0) - g + ridge * len(y) / 50.0 * np.eye(X.shape[1])) for g in G]
        gain = _gain(parts, rows, inverse, y)
        if gain > best[0]:
            best, kept = (gain, 1.0), inverse
    if best[0] <= 0.0:
        return best
    rng = np.random.default_rng(3)
    shifts = rng.integers(len(y) // 12, len(y) - len(y) // 12, size=SHIFTS)
    null = np.array([_gain(parts, rows, kept, np.roll(y, int(s))) for s in shifts])
    z = (best[0] - null.mean()) / (null.std(ddof=1) + 1e-30)
    shifted, steady = 1.0 if within else float(student.sf(z, SHIFTS - 1)), _steady(parts, rows, kept, y)
    if steady > REPEATS:  # one lucky stretch, however lucky
        return best[0], 1.0
    return best[0], min(1.0, len(RIDGES) * min(shifted, steady * (1.0 if within else 2.0)))


def _steady(parts: list[np.ndarray], rows: list[np.ndarray], inverse: list[np.ndarray], y: np.ndarray) -> float:
    """p-value that the gain is no more than zero on average over stretches of time."""
    b = [x.T @ y[r] for x, r in zip(parts, rows, strict=True)]
    whole = np.sum(b, axis=0)
    gain = np.zeros(len(y))
    for x, r, w, v in zip(parts, rows, inverse, b, strict=True):
        gain[r] = y[r] ** 2 - (y[r] - x @ (w @ (whole - v))) ** 2
    blocks = np.array([g.mean() for g in np.array_split(gain, STRETCHES)])
    # noise that remembers longer than a stretch makes neighbours alike, and the mean less sure than it looks
    away = blocks - blocks.mean()
    alike = [
        (1.0 - k / (ALIKE + 1)) * float(away[k:] @ away[:-k]) / float(away @ away + 1e-30) for k in range(1, ALIKE + 1)
    ]
    wide = max(1.0, 1.0 + 2.0 * sum(alike))
    return float(student.sf(blocks.mean() / (np.sqrt(wide / STRETCHES) * blocks.std(ddof=1) + 1e-30), STRETCHES - 1))


def _gain(parts: list[np.ndarray], rows: list[np.ndarray], inverse: list[np.ndarray], y: np.ndarray) -> float:
    b = [x.T @ y[r] for x, r in zip(parts, rows, strict=True)]
    whole = np.sum(b, axis=0)
    left = sum(
        float(np.sum((y[r] - x @ (w @ (whole - v))) ** 2)) for x, r, w, v in zip(parts, rows, inverse, b, strict=True)
    )
    return (float(y @ y) - left) / len(y)
