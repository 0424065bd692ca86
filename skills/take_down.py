"""Lift the gown off its hook with both hands and carry it away from the rail."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..perception.estimates import GraspPoint
from ..sim.mechanics.planar import planar_pose
from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES
from .control.base import drive_to
from .control.hands import cloth_load, hand_now, move_hands
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class TakeDownTuning(Quantities):
    """Numbers of `TakeDown`."""

    elevations: tuple[float, ...] = quantity(
        tuple(float(np.deg2rad(angle)) for angle in (-35.0, -5.0, 10.0, 20.0, 30.0, 40.0)),
        "rad",
        "of the neckline from the hook to each hand, above level, step by step",
        "choice: large steps while the hook carries the gown, small ones where it lets go",
    )
    stretch: float = quantity(
        0.95,
        "1",
        "share of each hand's distance from the hook that is kept",
        "choice: the hook must not pull at the hands",
    )
    clearance: float = quantity(
        0.03, "m", "of the hands before the hook, towards the robot", "choice: how it was found is not recorded"
    )
    max_growth: float = quantity(
        0.12, "N", "of the load since the last step, once the hook carries nothing more", "choice: above the noise"
    )
    speed: float = quantity(0.25, "m/s", "of each hand", "choice: the gown hardly swings")
    weighing_time: float = quantity(0.3, "s", "of rest before each weighing", "choice: the load settles")
    retreat_distance: float = quantity(0.30, "m", "by which the base backs off", "choice: clear of the rail")
    base_speed: float = quantity(0.3, "m/s", "of the base on its way back", "choice: the gown hardly swings")
    settle_time: float = quantity(0.5, "s", "of rest before the last weighing", "choice: the gown swings out")


class TakeDown(Skill):
    """Raises both hands on arcs about the hook until they carry the whole gown, then drives back from the rail.

    Each hand keeps its distance from the hook, so that the neckline is neither stretched nor dropped.  It fails where
    the hands, or one of them, carry too little in the end.
    """

    hook = Input(GraspPoint, unit="m, map", doc="where the gown hangs")
    min_load = Input(float, unit="N", doc="least load that both hands together must carry", default=2.8)
    min_load_each = Input(float, unit="N", doc="least load that each hand must carry", default=0.6)
    tuning = Input(TakeDownTuning, default=TakeDownTuning(), doc="numbers of this skill")
    load = Output(float, unit="N", doc="that both hands carry together")
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.GRASP_MISSED)

    def steps(self) -> Iterator[None]:
        """Raise and weigh in turn; drive back, weigh again."""
        tuning = self.tuning
        self.note("lifts the gown off the rail")
        base = planar_pose(self.world.observe().pose_base_in_map)
        hook = self.hook.position_in_map - tuning.clearance * base[:3, 0]
        reach = {side: tuning.stretch * float(np.linalg.norm(hand_now(self, side)[:3, 3] - hook)) for side in SIDES}
        carried = self._carried()
        for angle in tuning.elevations:
            goals = {}
            for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
                pose = hand_now(self, side)
                pose[:3, 3] = hook + reach[side] * (
                    sign * math.cos(angle) * base[:3, 1] + math.sin(angle) * base[:3, 2]
                )
                goals[side] = pose
            yield from move_hands(self, goals, speed=tuning.speed, free="any", way="either")
            yield from self.wait(tuning.weighing_time)
            before, carried = carried, self._carried()
            if angle > 0.0 and carried > self.min_load and carried - before < tuning.max_growth:
                break
        here = self.world.observe().pose_base_in_map
        back = here.copy()
        back[:2] -= tuning.retreat_distance * base[:2, 0]
        yield from drive_to(self, back, straight=True, speed=tuning.base_speed)
        yield from self.wait(tuning.settle_time)
        self.load = self._carried()
        least = min(-float(cloth_load(self, side)[2]) for side in SIDES)
        if self.load < self.min_load or least < self.min_load_each:
            raise SkillFailure(Reason.GRASP_MISSED, f"the hands carry {self.load:.1f} N, one of them {least:.1f} N")

    def _carried(self) -> float:
        return float(-sum(cloth_load(self, side)[2] for side in SIDES))
