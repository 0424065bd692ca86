"""Rests: where nothing moves, dry friction may be anything up to its level, so loads say nothing about it.

A drive that holds its place by position control rests with whatever load its friction bore as it came to stand.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..regions import intervals
from .block import Block
from .log import JointLog

DRY = ("coulomb_friction", "asymmetric_friction", "stribeck_friction", "load_friction")
SHORTEST = 0.25  # [s] of a rest; a joint that turns round is as slow for less
JOINED = 0.1  # [s] within which two rests are one, interrupted by noise


def moving(log: JointLog) -> JointLog:
    """The log without its rests; as it is where it has none, or hardly anything else."""
    still = np.all(np.abs(log.dq) < log.slow, axis=1)
    return log.without(intervals(still, log.t, JOINED, SHORTEST))


def has_dry_friction(blocks: Sequence[Block]) -> bool:
    """Whether something among the effects is not known at rest."""
    return any(b.name in DRY for b in blocks)


def left_out(logs: Sequence[JointLog]) -> float:
    """Time that is left out of some logs [s]."""
    return float(sum(log.dt * log.left_out.sum() for log in logs if log.left_out is not None))
