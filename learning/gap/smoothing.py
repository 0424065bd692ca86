"""Zero-phase low-pass filters and derivatives for logs, with a bandwidth the log itself decides.

The bandwidth is the highest frequency at which the log still rises above its own noise plateau, but not far beyond
what the motion's speed consists of: a sensor that filters its own noise has hardly a plateau, and what stands above it
at a hundred times the motion's frequency is noise, which two derivatives would make louder than the motion.  Both sides
of the force balance go through the same filter, so that what it removes is removed from model and measurement alike.
"""

from __future__ import annotations

import numpy as np
from numpy.fft import irfft, rfft, rfftfreq

ORDER = 4  # of the Butterworth-like gain; squared once, phase zero
SPEED_PART = 0.999  # of the energy of the speed lies below the motion's highest frequency
REACH = (6.0, 8.0)  # bandwidth over that frequency: as wide where noise allows, and no wider
OF_RATE = 0.01  # bandwidth over the sampling rate that a log may always have: sharp effects need it in slow motion
NOISY = 0.05  # noise of the acceleration over the acceleration, from which on a log's own bandwidth is not widened
FEWEST_PERIODS = 4  # of the bandwidth in a log, at least


def lowpass(x: np.ndarray, dt: float, cutoff: float) -> np.ndarray:
    """Low-pass along the first axis, zero phase, ends mirrored through their end points.

    Args:
        x: (T, ...) samples.
        dt: time step [s].
        cutoff: half-power frequency [Hz]; at or above Nyquist nothing is done.
    """
    return _apply(x, dt, cutoff, 0)


def lowpass_both(x: np.ndarray, dt: float, first: float, second: float) -> np.ndarray:
    """Low-pass along the first axis through two filters in one pass; see `lowpass`."""
    return _apply(x, dt, min(first, second), 0, max(first, second))


def derivative(x: np.ndarray, dt: float, cutoff: float, order: int) -> np.ndarray:
    """Low-passed time derivative of the given order (1 or 2) along the first axis, exact below the cutoff."""
    return _apply(x, dt, cutoff, order)


def _apply(x: np.ndarray, dt: float, cutoff: float, order: int, wider: float = np.inf) -> np.ndarray:
    n = len(x)
    nyquist = 0.5 / dt
    if order == 0 and cutoff >= nyquist:
        return np.array(x, dtype=float)
    pad = int(min(n - 1, max(16, np.ceil(4.0 / (cutoff * dt)))))
    head = 2.0 * x[0] - x[pad:0:-1]
    tail = 2.0 * x[-1] - x[-2 : -pad - 2 : -1]
    extended = np.concatenate([head, x, tail])
    m = len(extended)
    # a straight line through the ends makes the periodic extension continuous
    ramp = np.linspace(0.0, 1.0, m).reshape(-1, *([1] * (x.ndim - 1)))
    line = extended[0] + (extended[-1] - extended[0]) * ramp
    f = rfftfreq(m, dt).reshape(-1, *([1] * (x.ndim - 1)))
    gain = 1.0 / (1.0 + (f / cutoff) ** (2 * ORDER)) if cutoff < nyquist else np.ones_like(f)
    if wider < nyquist:
        gain = gain / (1.0 + (f / wider) ** (2 * ORDER))
    spectrum = rfft(extended - line, axis=0) * gain * (2j * np.pi * f) ** order
    out = irfft(spectrum, n=m, axis=0)
    if order == 0:
        out = out + line
    elif order == 1:
        out = out + (extended[-1] - extended[0]) / ((m - 1) * dt)
    return out[pad : pad + n]


def bandwidth(x: np.ndarray, dt: float, margin: float = 6.0) -> tuple[float, float]:
    """Frequency up to which a log rises above its noise, and the noise's standard deviation.

    Args:
        x: (T,) samples.
        dt: time step [s].
        margin: smoothed power over plateau that still counts as signal.

    Returns:
        (cutoff [Hz] of at most 40 % of the sampling rate, noise standard deviation of `x`).
    """
    n = len(x)
    taper = np.hanning(n)
    ramp = np.linspace(x[0], x[-1], n)
    power = np.abs(rfft((x - ramp) * taper)) ** 2 / np.sum(taper**2)
    f = rfftfreq(n, dt)
    width = max(3, n // 400)
    smooth = np.convolve(power, np.ones(width) / width, mode="same")
    top = f > 0.6 * f[-1]
    plateau = float(np.median(power[top])) / np.log(2.0) if top.any() else 0.0
    above = np.flatnonzero(smooth[1:] > margin * max(plateau, 1e-30)) + 1
    # the signal band ends at the first stretch of silence, so a lone line far out does not widen it
    cutoff = f[1]
    last = 0
    for i in above:
        if last and i - last > max(5, n // 50):
            break
        last, cutoff = i, f[i]
    signal = np.where(f <= cutoff, np.maximum(power - plateau, 0.0), 0.0)
    speed = np.cumsum(f**2 * signal)
    if speed[-1] > 0.0:
        highest = f[np.searchsorted(speed, SPEED_PART * speed[-1])]
        # white noise of this plateau in the acceleration up to each frequency
        quiet = np.cumsum(f**4) * plateau <= NOISY**2 * np.sum(f**4 * signal)
        near, far = (max(reach * highest, OF_RATE / dt) for reach in REACH)
        cutoff = min(max(cutoff, min(near, f[quiet][-1])), far)
    return float(np.clip(cutoff, FEWEST_PERIODS / (n * dt), 0.4 / dt)), float(np.sqrt(max(plateau, 0.0)))


def resample(t: np.ndarray, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Put (T, k) columns on a uniform grid of the median time step.

    Returns:
        (t (N,), columns (N, k), dt [s]).
    """
    dt = float(np.median(np.diff(t)))
    n = round((t[-1] - t[0]) / dt) + 1
    grid = t[0] + dt * np.arange(n)
    if n == len(t) and np.abs(t - grid).max() < 0.02 * dt:
        return grid, columns, dt
    return grid, np.stack([np.interp(grid, t, c) for c in columns.T], axis=1), dt
