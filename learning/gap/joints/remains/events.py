"""Contacts that happen at a time rather than at a place: bursts of load that no function of the state explains."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...regions import intervals
from ..log import JointLog

SHORT = 0.3  # [s]
LONGEST = 0.35  # a burst may last this part of an episode
END = 0.05  # bursts this close to either end of a log may be the filter's
LOUDER = 2.0  # root mean square inside a burst over the usual one, behind the shared filter
PEAK = 8.0  # smoothed leftover over its robust deviation before anything counts as a burst


@dataclass(frozen=True, kw_only=True)
class Burst:
    """One burst.  load: mean leftover inside, signed [N or N m]; strength: over the robust noise."""

    episode: str
    channel: int
    t0: float
    t1: float
    load: float
    strength: float


def bursts(logs: list[JointLog], left: list[np.ndarray], channel: int) -> list[Burst]:
    """Bursts in one channel's leftover.

    Args:
        logs: the logs.
        left: (T_inner, C) per log.
        channel: which joint.
    """
    out = []
    smooth_all = []
    for log, series in zip(logs, left, strict=True):
        width = max(3, int(0.06 * len(series) * 0.5))
        width = min(width, max(3, int(0.12 / log.dt)))
        kernel = np.hanning(2 * width + 1)
        smooth_all.append(np.convolve(series[:, channel], kernel / kernel.sum(), mode="same"))
    pooled = np.concatenate(smooth_all)
    centre = float(np.median(pooled))
    spread = 1.4826 * float(np.median(np.abs(pooled - centre))) + 1e-12
    for log, smooth in zip(logs, smooth_all, strict=True):
        t = log.t[log.inner]
        z = (smooth - centre) / spread
        span = t[-1] - t[0]
        for a, b in intervals(np.abs(z) > 3.0, t, 0.02 * span, 0.0):
            rows = (t >= a) & (t <= b)
            inside = a > t[0] + END * span and b < t[-1] - END * span
            if np.abs(z[rows]).max() > PEAK and inside and b - a < LONGEST * span and not _turns(log, channel, a, b):
                out.append(
                    Burst(
                        episode=log.name,
                        channel=channel,
                        t0=float(a),
                        t1=float(b),
                        load=float(smooth[rows].mean()),
                        strength=float(np.abs(z[rows]).max()),
                    )
                )
    return out


def stands_out(burst: Burst, logs: list[JointLog], left: list[np.ndarray]) -> bool:
    """Whether a leftover (T_inner, C) per log is louder inside a burst than the rest of its log is.

    Args:
        burst: found in a leftover of the same logs.
        logs: the logs.
        left: what is left of them behind the filter both sides of the balance go through.
    """
    log, x = next((log, x[:, burst.channel]) for log, x in zip(logs, left, strict=True) if log.name == burst.episode)
    t = log.t[log.inner]
    spread = 1.4826 * float(np.median(np.abs(x - np.median(x))))
    return bool(np.sqrt(np.mean(x[(t >= burst.t0) & (t <= burst.t1)] ** 2)) > LOUDER * spread)


def burst_share(logs: list[JointLog], left: list[np.ndarray], channel: int, found: list[Burst]) -> float:
    """Part of the leftover's energy inside the bursts; 0 where they are not three times as strong as the rest."""
    total = inside = 0.0
    time = within = 0
    for log, series in zip(logs, left, strict=True):
        t = log.t[log.inner]
        energy = (series[:, channel] - np.median(series[:, channel])) ** 2
        rows = np.zeros(len(t), dtype=bool)
        for b in found:
            if b.episode == log.name:
                rows |= (t >= b.t0) & (t <= b.t1)
        total += energy.sum()
        inside += energy[rows].sum()
        time, within = time + len(rows), within + int(rows.sum())
    share = inside / (total + 1e-30)
    return share if share > 3.0 * within / max(time, 1) else 0.0


def _turns(log: JointLog, channel: int, a: float, b: float) -> bool:
    """Whether a short burst sits on a reversal of the joint: then it is friction or play, not a contact."""
    if b - a > SHORT:
        return False
    v = log.dq[(log.t >= a - 0.05) & (log.t <= b + 0.05), channel]
    return bool(v.max() > 0.0 > v.min())
