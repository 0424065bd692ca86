"""Rests: where nothing moves, dry friction may be anything up to its level, so loads say nothing about it.

A drive that holds its place by position control rests with whatever load its friction bore as it came to stand.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..regions import intervals
from .block import Block
from .log import FEWEST, JointLog

DRY = ("coulomb_friction", "asymmetric_friction", "stribeck_friction", "load_friction")
SHORTEST = 0.25  # [s] of a rest; a joint that turns round is as slow for less
JOINED = 0.1  # [s] within which two rests are one, interrupted by noise
REACH = 0.75  # periods of the filters' cutoff by which a rest's load is smeared into the motion beside it


def moving(log: JointLog) -> JointLog:
    """The log without its rests; as it is where it has none, or hardly anything else."""
    still = np.all(np.abs(log.dq) < log.slow, axis=1)
    found = intervals(still, log.t, JOINED, SHORTEST)
    if not found:
        return log
    reach = REACH / log.cutoff
    left_out = np.zeros(len(log.t), dtype=bool)
    for a, b in found:
        left_out |= (log.t >= a - reach) & (log.t <= b + reach)
    out = replace(log, left_out=left_out)
    return out if len(log.t[out.inner]) >= FEWEST else log


def has_dry_friction(blocks: Sequence[Block]) -> bool:
    """Whether something among the effects is not known at rest."""
    return any(b.name in DRY for b in blocks)


def rested(logs: Sequence[JointLog]) -> float:
    """Time that is left out of some logs [s]."""
    return float(sum(log.dt * log.left_out.sum() for log in logs if log.left_out is not None))
