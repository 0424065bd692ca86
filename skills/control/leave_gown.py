"""Let go of a gown whose neckline is down on the person, and draw both hands and the base back."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, Side
from ..core.skill import Skill
from ..geometry.stances import STANCES
from .base import drive_to
from .fingers import open_gripper
from .hands import hand_now, move_hands


@dataclass(frozen=True, kw_only=True)
class LeaveGownTuning(Quantities):
    """How the hands and the base leave the gown."""

    withdrawal: tuple[float, float, float] = quantity(
        (0.0, 0.06, 0.22), "m", "of the open hands in the map", "choice: up and off the cloth, towards the feet"
    )
    withdrawal_speed: float = quantity(0.3, "m/s", "of the open hands", "choice: they hold nothing")
    final_y: float = quantity(1.6, "m", "of the base in the end", "choice: the arms are clear of the bed")


def leave_gown(skill: Skill, tuning: LeaveGownTuning) -> Iterator[None]:
    """Open, rise, drive back.

    Args:
        skill: that moves.
        tuning: how far, and how fast.

    Raises:
        MotionError: out of reach, or something is in the way.
        SkillFailure: COMMAND_LOST, PATH_BLOCKED or TIMEOUT.
    """
    for side in SIDES:  # the near corner first: then its back panel swings out over the edge of the bed
        yield from open_gripper(skill, side)
    skill.note("withdraws")
    up: dict[Side, np.ndarray] = {side: hand_now(skill, side) for side in SIDES}
    for pose in up.values():
        pose[:3, 3] += tuning.withdrawal
    yield from move_hands(skill, up, speed=tuning.withdrawal_speed, free="any", retreat=True)
    away = np.array((STANCES.lane, tuning.final_y, STANCES.heading))
    yield from drive_to(skill, away, straight=True, retreat=True)
