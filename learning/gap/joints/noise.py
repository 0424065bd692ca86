"""The noise of each channel: how large it is and how long it remembers.

With repeats of the same motion the noise is their deviation from the mean; without, it is what the model with all
found effects leaves.  Residuals of real logs are strongly coloured, so a squared correlation with n rows is worth far
less than n independent ones: `widening` is the factor by which the variance of a regressor's coefficient exceeds
the white-noise formula (the long-run variance of regressor times noise, a HAC estimate with a Bartlett window).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.fft import irfft, rfft
from scipy.fft import next_fast_len


@dataclass(frozen=True, kw_only=True)
class NoiseModel:
    """Noise per channel.

    Attributes:
        rms: (C,) in the units of the load.
        acf: (C, L) autocorrelation at lags 0..L-1, tapered to zero.
        source: `repeats` or `residual`.
    """

    rms: np.ndarray
    acf: np.ndarray
    source: str

    def widening(self, acf: np.ndarray, channel: int) -> np.ndarray:
        """Variance inflation for regressors with autocorrelation `acf` (L, K) on one channel, (K,), at least 1."""
        n = min(len(acf), self.acf.shape[1])
        # fitted residuals have negative lobes that hide slow noise, so the sum is stopped where it is largest
        running = 1.0 + 2.0 * np.cumsum(self.acf[channel, 1:n, None] * acf[1:n], axis=0)
        return np.maximum(running.max(axis=0), 1.0)


def autocorrelation(series: list[np.ndarray], lags: int, centre: bool = False) -> np.ndarray:
    """Pooled autocorrelation of columns over episodes.

    Args:
        series: one (T, K) array per episode.
        lags: number of lags, 0 included.
        centre: subtract each column's mean over all episodes first.

    Returns:
        (lags, K), 1 at lag 0.
    """
    mean = np.concatenate(series).mean(axis=0) if centre else 0.0
    total = np.zeros((lags, series[0].shape[1]))
    for x in series:
        n = next_fast_len(len(x) + lags)
        power = np.abs(rfft(x - mean, n=n, axis=0)) ** 2
        r = irfft(power, n=n, axis=0)[:lags]
        total[: len(r)] += r
    return total / np.maximum(total[0], 1e-30)


def lag_count(series: list[np.ndarray]) -> int:
    """Lags worth estimating: a sixth of the shortest episode."""
    return max(4, min(len(s) for s in series) // 6)


def estimate_noise(series: list[np.ndarray], source: str) -> NoiseModel:
    """Size and memory of noise-like series, one (T, C) array per episode."""
    lags = lag_count(series)
    taper = 1.0 - np.arange(lags) / lags
    acf = autocorrelation(series, lags) * taper[:, None]
    rms = np.sqrt(np.mean(np.concatenate(series) ** 2, axis=0)) + 1e-12
    return NoiseModel(rms=rms, acf=acf.T, source=source)


def repeat_difference(residuals: list[np.ndarray], motions: list[np.ndarray]) -> list[np.ndarray]:
    """Deviations from the mean of repeated episodes, unbiased in variance; empty where nothing repeats.

    Args:
        residuals: (T, C) per episode.
        motions: (T, C) positions per episode, to see which really repeat.
    """
    out: list[np.ndarray] = []
    free = list(range(len(residuals)))
    while free:
        i = free.pop(0)
        scale = motions[i].std() + 1e-12
        twins = [
            j
            for j in free
            if abs(len(motions[j]) - len(motions[i])) <= 2
            and np.sqrt(np.mean((motions[j][: len(motions[i])] - motions[i][: len(motions[j])]) ** 2)) < 0.01 * scale
        ]
        if not twins:
            continue
        n = min(len(motions[k]) for k in [i, *twins])
        stack = np.stack([residuals[k][:n] for k in [i, *twins]])
        deviation = (stack - stack.mean(axis=0)) * np.sqrt(len(stack) / (len(stack) - 1))
        out += list(deviation)
        free = [k for k in free if k not in twins]
    return out
