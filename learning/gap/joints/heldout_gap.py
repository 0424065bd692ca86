"""How far model and measurement are apart on recordings nothing was fitted to, before and after."""

from __future__ import annotations

import numpy as np

from ..findings import Gap


def gap_of(
    before: list[np.ndarray], after: list[np.ndarray], floor: np.ndarray, channels: tuple[str, ...], unit: str
) -> Gap:
    """The gap over all held-out rows, with an interval of after / before from resampled stretches."""
    b, a = np.concatenate(before), np.concatenate(after)
    rows = np.array_split(np.arange(len(b)), 20)
    sums = np.array([[np.sum(b[r] ** 2), np.sum(a[r] ** 2)] for r in rows])
    rng = np.random.default_rng(0)
    ratios = [
        np.sqrt(s[1] / max(s[0], 1e-30)) for s in (sums[rng.integers(20, size=20)].sum(axis=0) for _ in range(400))
    ]
    low, high = np.quantile(ratios, [0.025, 0.975])
    rb, ra = (np.sqrt(np.mean(x**2, axis=0)) for x in (b, a))
    return Gap(
        unit=unit,
        floor=float(np.sqrt(np.mean(floor**2))),
        before=float(np.sqrt(np.mean(b**2))),
        after=float(np.sqrt(np.mean(a**2))),
        low=float(low),
        high=float(high),
        channels={
            name: {"floor": float(floor[i]), "before": float(rb[i]), "after": float(ra[i])}
            for i, name in enumerate(channels)
        },
    )
