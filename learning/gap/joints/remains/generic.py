"""A basis for "some function of the state and its recent past", which notices effects the registry lacks."""

from __future__ import annotations

import numpy as np

from ..log import JointLog

FEATURES = 36


def scales(logs: list[JointLog]) -> np.ndarray:
    """(4, 2, C) mean and deviation of position, velocity, acceleration and rigid load over all logs."""
    stack = [np.concatenate([getattr(log, name)[log.inner] for log in logs]) for name in ("q", "dq", "ddq", "rigid")]
    return np.array([[x.mean(axis=0), x.std(axis=0) + 1e-9] for x in stack])


def generic_columns(log: JointLog, channel: int, scale: np.ndarray) -> np.ndarray:
    """Smooth functions of one joint's state and of time, through the shared filter, (T_inner, p)."""
    q, v, a, u = (
        (getattr(log, name)[:, channel] - scale[i, 0, channel] * (i != 1)) / scale[i, 1, channel]
        for i, name in enumerate(("q", "dq", "ddq", "rigid"))
    )
    s = np.tanh(2.0 * log.dq[:, channel] / max(log.slow[channel], 1e-12))
    angle = log.q[:, channel]
    rng = np.random.default_rng(7)
    w = rng.normal(size=(4, FEATURES)) * np.array([[1.2], [1.2], [0.5], [0.5]])
    phase = rng.uniform(0, 2 * np.pi, FEATURES)
    waves = np.cos(np.stack([q, v, a, u], axis=1) @ w + phase)
    plain = [
        np.ones_like(q),
        q,
        v,
        a,
        u,
        s,
        s * np.abs(u),
        v * np.abs(v),
        v**3,
        q**2,
        q**3,
        q * v,
        s * q,
        s * q**2,
        a * v,
        np.sin(angle),
        np.cos(angle),
        np.sin(2 * angle),
        np.cos(2 * angle),
        s * np.exp(-((v / 0.1) ** 2)),
        s * np.exp(-((v / 0.4) ** 2)),
    ]
    around = [
        getattr(log, name)[:, j] / scale[i, 1, j]
        for j in (channel - 1, channel + 1)
        if 0 <= j < log.q.shape[1]
        for i, name in ((1, "dq"), (2, "ddq"))
    ]
    return log.shared(np.column_stack([*plain, *around, waves]))


PLACES = 9


def place_columns(log: JointLog, channel: int, scale: np.ndarray) -> np.ndarray:
    """Bumps over the range of a joint, alone and in the direction of motion, (T_inner, 18)."""
    q = (log.q[:, channel] - scale[0, 0, channel]) / scale[0, 1, channel]
    centres = np.linspace(-1.8, 1.8, PLACES)
    bumps = np.exp(-(((q[:, None] - centres) / (0.8 * (centres[1] - centres[0]))) ** 2))
    return log.shared(np.concatenate([bumps, bumps * log.motion(channel).direction[:, None]], axis=1))


def past_columns(log: JointLog, channel: int) -> np.ndarray:
    """States that remember the way, alone and with the load, (T_inner, 5)."""
    angle, u = log.q[:, channel], log.rigid[:, channel]
    past = [wind_up(angle, part * (np.ptp(angle) + 1e-9)) for part in (0.01, 0.04, 0.15)]
    return log.shared(np.column_stack([*past, past[0] * u, past[1] * u]))


def wind_up(q: np.ndarray, distance: float) -> np.ndarray:
    """A state that remembers the way: it follows the motion's direction over about `distance`, (T,)."""
    z = np.zeros(len(q))
    steps = np.diff(q) / distance
    x = 0.0
    for i, d in enumerate(steps):
        x = min(1.0, max(-1.0, x + d - abs(d) * x))
        z[i + 1] = x
    return z


def clock_columns(log: JointLog, channel: int) -> np.ndarray:
    """Slow functions of time, alone (drift) and times the state (friction while warming up), (T_inner, 10)."""
    x = np.linspace(-1.0, 1.0, len(log.t[log.inner]))
    v, s, u, q = (getattr(log.motion(channel), name) for name in ("dq", "direction", "load", "q"))
    state = log.shared(np.stack([v, s, u, q], axis=1))
    slow = np.stack([x, x**2 - 1.0 / 3.0], axis=1)
    return np.concatenate([slow, state * slow[:, :1], state * slow[:, 1:]], axis=1)


def other_columns(log: JointLog, channel: int, other: int, scale: np.ndarray) -> np.ndarray:
    """What another joint does: position, its square and wave, its product with the joint's own, motion (T_inner, 7)."""
    q, v, a, u = (
        (getattr(log, name) - scale[i, 0] * (i != 1)) / scale[i, 1]
        for i, name in enumerate(("q", "dq", "ddq", "rigid"))
    )
    bound = [q[:, other], q[:, other] ** 2, np.sin(2.0 * log.q[:, other]), q[:, other] * q[:, channel]]
    return log.shared(np.column_stack([*bound, v[:, other], a[:, other], u[:, other]]))
