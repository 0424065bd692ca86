"""A guess at the formula behind a leftover no effect explains, by sparse regression (pysindy's STLSQ)."""

from __future__ import annotations

import warnings

import numpy as np

from ..log import JointLog
from .remainder import Remainder


def guess(logs: list[JointLog], left: list[np.ndarray], found: Remainder) -> str:
    """Two or three terms in q, v, a and u (position, velocity, acceleration, rigid load) that track the leftover best.

    Returns:
        A formula with fitted factors and the part of the leftover's energy it explains, for the reader to judge.
    """
    c = found.channel
    y = np.concatenate([x[:, c] for x in left])
    if found.kind == "other joint":
        return f"about {np.sqrt(found.energy):.3g}, {found.detail}"
    q, v, a, u = (
        np.concatenate([getattr(log, n)[log.inner][:, c] for log in logs]) for n in ("q", "dq", "ddq", "rigid")
    )
    if found.kind in ("position wave", "time wave", "drift"):
        return f"about {np.sqrt(2 * found.energy):.3g} times a wave or trend: {found.detail}"
    slow = float(np.median([log.slow[c] for log in logs]))
    s = np.tanh(2 * v / max(slow, 1e-12))
    terms = {
        "v|v|": v * np.abs(v),
        "v^3": v**3,
        "q v": q * v,
        "q^2": q**2,
        "q^3": q**3,
        "v^2": v**2,
        "a|a|": a * np.abs(a),
        "sin(2q)": np.sin(2 * q),
        "sin(q)": np.sin(q),
        "cos(q)": np.cos(q),
        "q^2 v": q**2 * v,
        "q sign(v)": q * s,
        "q^2 sign(v)": q**2 * s,
        "a v": a * v,
        "u v": u * v,
        "u q": u * q,
        "sign(v) sqrt|v|": s * np.sqrt(np.abs(v)),
        "v": v,
        "sign(v)": s,
        "q": q,
        "a": a,
        "u": u,
        "1": np.ones_like(q),
    }
    X = np.stack(list(terms.values()), axis=1)
    X = _filtered(X, logs)
    size = np.sqrt(np.mean(X**2, axis=0)) + 1e-12
    coefficients = _stlsq(X / size, y) / size
    order = np.argsort(-np.abs(coefficients * size))[:3]
    order = [i for i in order if coefficients[i] != 0.0]
    if not order:
        return "no short formula in q, v, a and the rigid load tracks it"
    theta = np.linalg.lstsq(X[:, order], y, rcond=None)[0]
    part = 1.0 - np.mean((y - X[:, order] @ theta) ** 2) / np.mean(y**2)
    names = list(terms)
    formula = " ".join(f"{t:+.3g} {names[i]}" for t, i in zip(theta, order, strict=True)).lstrip("+")
    return f"{formula} ({100 * max(part, 0):.0f} % of what is left in this channel)"


def _filtered(X: np.ndarray, logs: list[JointLog]) -> np.ndarray:
    from ...smoothing import lowpass

    at, out = 0, []
    for log in logs:
        n = len(log.t[log.inner])
        out.append(lowpass(X[at : at + n], log.dt, log.cutoff))
        at += n
    return np.concatenate(out)


def _stlsq(X: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Sequentially thresholded least squares, threshold raised until three terms are left."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from pysindy.optimizers import STLSQ

        best = np.zeros(X.shape[1])
        for threshold in np.sqrt(np.mean(y**2)) * np.array([0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8]):
            fitted = STLSQ(threshold=float(threshold), alpha=1e-3).fit(X, y[:, None])
            found = np.asarray(fitted.coef_).ravel()
            if not np.any(found):
                break
            best = found
            if np.count_nonzero(found) <= 3:
                break
    return best
