"""Loads that cannot be those of the model: they have lost their sign, have the other one, or lack gravity."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .log import JointLog
from .rigid import RigidModel

BETTER = 0.5  # of what the model misses is left with the other sign, or without gravity
BOTH_WAYS = 0.05  # of the rows at least have either sign in the model
RIPPLE = 0.02  # of the largest load, by which the filter that thins a log reaches below its least
WEIGHTLESS = 0.3  # of what moves the heaviest joint, from which on what holds it up is in its load too
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
    weight = np.concatenate([_held(model, log) for log in logs])
    c = int(np.argmax(weight.std(axis=0)))
    parts = np.column_stack([rigid[:, c] - weight[:, c], weight[:, c]])  # in currents both are small, not one alone
    moving, held = np.linalg.lstsq(parts, measured[:, c], rcond=None)[0]
    lighter = np.mean((measured - rigid + weight) ** 2) < BETTER * np.mean((measured - rigid) ** 2)
    if lighter and abs(held) < WEIGHTLESS * moving:
        return f"columns {columns[0]} to {columns[-1]} hardly have gravity in them, which the model has"
    return ""


def _alike(x: np.ndarray, y: np.ndarray) -> float:
    return float(np.corrcoef(x, y)[0, 1])


def _held(model: RigidModel, log: JointLog) -> np.ndarray:
    """Load that holds the model still at each position, (T_inner, n)."""
    q = log.q[log.inner]
    return model.load(q, np.zeros_like(q), np.zeros_like(q))
