"""What of a load is no measurement: its sensor stands still, is at an end of its range, or leaves it for a sample."""

from __future__ import annotations

import numpy as np

STILL = 0.1  # [s] from which on a load that does not change at all, while its joint moves, is not measured
LONGER = 20  # times the usual run of equal values, and samples, at least
MOVES = 0.01  # part of its range that the joint goes meanwhile
CUT_OFF = 10  # samples at the largest or least value, at least,
OFTENER = 4  # and times those at the next one: a load that is rounded meets its ends no more often
SPIKE = 20.0  # times the usual distance of a sample from the mean of both neighbours
AGREE = 0.5  # of it, within which those are alike: beside a step they are not
NOISY = 1e-5  # of the load: without noise, as a simulation writes it, equal values are nothing strange


def unsound(t: np.ndarray, q: np.ndarray, load: np.ndarray) -> list[tuple[float, float]]:
    """Stretches [s] in which a load's sensor stands still while the joint moves, or is at an end of its range.

    Args:
        t: (N,) [s].
        q: (N,) position of its joint.
        load: (N,) as recorded.
    """
    bend = np.abs(np.diff(load, 2))
    if len(load) < LONGER or np.median(bend) <= NOISY * np.sqrt(np.mean(load**2)):
        return []
    starts = np.concatenate([[0], np.flatnonzero(np.diff(load) != 0) + 1, [len(load)]])
    lengths = np.diff(starts)
    usual, reach = float(lengths.mean()), MOVES * np.ptp(q)
    cut_off = _cut_off(load)
    return [
        (float(t[a]), float(t[a + n - 1]))
        for a, n in zip(starts[:-1], lengths, strict=True)
        if load[a] in cut_off
        or (n >= LONGER * max(usual, 1.0) and t[a + n - 1] - t[a] >= STILL and np.ptp(q[a : a + n]) > reach)
    ]


def without_spikes(load: np.ndarray) -> np.ndarray:
    """A load (N,) whose single samples far off both neighbours, which agree, are what lies between these."""
    between = 0.5 * (load[:-2] + load[2:])
    off = np.abs(load[1:-1] - between)
    usual = float(np.median(off))
    if usual <= NOISY * np.sqrt(np.mean(load**2)):
        return load
    spike = (off > SPIKE * usual) & (np.abs(load[2:] - load[:-2]) < AGREE * off)
    out = load.copy()
    out[1:-1][spike] = between[spike]
    return out


def _cut_off(load: np.ndarray) -> set[float]:
    """Ends of the range that are met far oftener than the value beside them."""
    values, counts = np.unique(load, return_counts=True)
    if len(values) < 3:
        return set()
    ends = ((values[0], counts[0], counts[1]), (values[-1], counts[-1], counts[-2]))
    return {float(x) for x, here, beside in ends if here >= CUT_OFF and here > OFTENER * beside}
