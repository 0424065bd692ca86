"""What cannot be of the model: loads that lost their sign, have the other one or lack gravity, zeros elsewhere."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .log import JointLog
from .rigid import RigidModel

BETTER = 0.5  # of what the model misses is left with the other sign, or without gravity
BOTH_WAYS = 0.05  # of the rows at least have either sign in the model
RIPPLE = 0.02  # of the largest load, by which the filter that thins a log reaches below its least
WEIGHTLESS = 0.3  # of what moves the heaviest joint, from which on what holds it up is in its load too
LEFT = 0.2  # of what the model misses is left with the zeros of joints elsewhere, from which on they are there
QUARTERS = (0.5 * np.pi, -0.5 * np.pi, np.pi)  # by which conventions of joints' zeros differ [rad]
LOOKED_AT = 300  # rows at which other zeros are tried
SIZE = 0.3  # by which a load goes rather with the model's size than with its value, as a correlation


def doubts(model: RigidModel, logs: Sequence[JointLog], columns: Sequence[str]) -> str:
    """What the loads of some logs look like, where that is no measurement of this model; "" where nothing is odd.

    Args:
        model: as the user gave it.
        logs: at least one.
        columns: names of the loads.
    """
    measured, rigid = (np.concatenate([getattr(log, n)[log.inner] for log in logs]) for n in ("measured", "rigid"))
    least = np.min([log.raw.min(axis=0) for log in logs], axis=0)
    for c, name in enumerate(columns):
        x, y = measured[:, c], rigid[:, c]
        both = min(np.mean(y > 0), np.mean(y < 0)) > BOTH_WAYS
        if x.std() == 0 or y.std() == 0:
            continue
        if both and least[c] > -RIPPLE * np.abs(x).max() and _alike(x, np.abs(y)) > _alike(x, y) + SIZE:
            return f"column '{name}' is never below 0 and goes with the size of the model's load: its sign is lost"
        if _alike(x, y) < 0 and np.mean((x + y) ** 2) < BETTER * np.mean((x - y) ** 2):
            return f"column '{name}' is nearly minus the model's load: its sign, or that of the joint, is the other one"
    if elsewhere := _elsewhere(model, logs):  # asked first: with other zeros, gravity is not where the model has it
        return elsewhere
    weight = np.concatenate([_held(model, log) for log in logs])
    c = int(np.argmax(weight.std(axis=0)))
    parts = np.column_stack([rigid[:, c] - weight[:, c], weight[:, c]])  # in currents both are small, not one alone
    moving, held = np.linalg.lstsq(parts, measured[:, c], rcond=None)[0]
    lighter = np.mean((measured - rigid + weight) ** 2) < BETTER * np.mean((measured - rigid) ** 2)
    if lighter and abs(held) < WEIGHTLESS * moving:
        return f"columns {columns[0]} to {columns[-1]} hardly have gravity in them, which the model has"
    return ""


def _elsewhere(model: RigidModel, logs: Sequence[JointLog]) -> str:
    """Which joints have their zeros a quarter or half a turn off, by what the model misses there; "" for none."""
    turning = [j for j, slides in enumerate(model.prismatic) if not slides]
    q, dq, ddq, measured = (
        np.concatenate([getattr(log, n)[log.inner] for log in logs]) for n in ("q", "dq", "ddq", "measured")
    )
    rows = np.linspace(0, len(q) - 1, min(LOOKED_AT, len(q))).astype(int)
    q, dq, ddq, measured = (x[rows] for x in (q, dq, ddq, measured))

    def missed(off: np.ndarray) -> float:
        return float(np.mean((measured - model.load(q + off, dq, ddq)) ** 2))

    zeros, least = np.zeros(q.shape[1]), missed(np.zeros(q.shape[1]))
    given = least
    while True:
        tries = [zeros + turn * (np.arange(len(zeros)) == j) for j in turning if not zeros[j] for turn in QUARTERS]
        left, best = min(((missed(z), k) for k, z in enumerate(tries)), default=(np.inf, 0))
        if not left < BETTER * least:
            break
        zeros, least = tries[best], left
    if not least < LEFT * given:
        return ""
    told = " and ".join(f"{np.degrees(zeros[j]):+.0f} degrees on {model.joints[j]}" for j in np.flatnonzero(zeros))
    return f"joints have their zeros elsewhere than the model: with {told}, {least / given:.1%} of the squares are left"


def _alike(x: np.ndarray, y: np.ndarray) -> float:
    return float(np.corrcoef(x, y)[0, 1])


def _held(model: RigidModel, log: JointLog) -> np.ndarray:
    """Load that holds the model still at each position, (T_inner, n)."""
    q = log.q[log.inner]
    return model.load(q, np.zeros_like(q), np.zeros_like(q))
