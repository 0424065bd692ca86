"""The room of `wash_arm`, and what is asked of a run there: truth, which the tree never sees."""

from __future__ import annotations

import numpy as np

from ....sim.abilities import SupportsObjects
from ....sim.evaluate.run_record import Checks, Judgement, RunRecord
from ....sim.world import SIDES

ELBOW_UP = 0.12  # [m] above where it lay: a hand with a cloth then reaches round the upper arm


def scene(world: SupportsObjects, seed: int) -> None:
    """The person on the bed, and no gown."""
    world.remove_gown()


def judge(record: RunRecord) -> Judgement:
    """The arm was held up as long as was asked for, both arms lie in the end, and nobody is harmed."""
    checks = Checks(record)
    arm = SIDES.index(record.parameters["arm"])
    held = (record.holds_arm == arm).any(axis=1)
    elbow = record.arms[:, arm, 1, 2]
    up = held & (elbow > elbow[0] + ELBOW_UP)
    checks.at_least("held_up", longest(record.t, up), record.parameters["seconds"], "s")
    checks.numbers["elbow_raised_m"] = float(np.max(elbow) - elbow[0])
    checks.arms_lie()
    checks.unharmed()
    return checks.judgement()


def longest(t: np.ndarray, holds: np.ndarray) -> float:
    """How long `holds` (T,) bool is true without a break [s]; `t` (T,) [s]."""
    best, since = 0.0, None
    for time, now in zip(t, holds, strict=True):
        since = (time if since is None else since) if now else None
        best = max(best, float(time - since) if since is not None else 0.0)
    return best
