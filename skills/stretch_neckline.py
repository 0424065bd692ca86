"""Draw apart the two hands that hold the ends of the neckline until it is stretched."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..sim.mechanics.planar import planar_pose
from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, HandTwist
from .control.hands import HANDS, cloth_load, hand_now, move_hands
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .geometry.arm_path import UP


@dataclass(frozen=True, kw_only=True)
class StretchNecklineTuning(Quantities):
    """Numbers of `StretchNeckline`."""

    distance: float = quantity(
        0.62, "m", "from the middle of the base ahead to the hands", "choice: before the chest, with room to draw apart"
    )
    height: float = quantity(1.36, "m", "of the hands above the floor", "choice: the gown hangs free")
    half_width: float = quantity(
        0.22, "m", "half the distance between the hands at first", "choice: the cloth is slack"
    )
    approach_speed: float = quantity(0.35, "m/s", "of the hands until there", "choice: the gown hardly swings")
    approach_load: float = quantity(
        6.0,
        "N",
        "on a hand that has more than cloth's weight between the two: they go no farther apart",
        "choice: above the whole gown, 4.0 to 4.8 N; held 0.44 m apart, a shorter piece pulled with 22 N (281)",
    )
    speed: float = quantity(
        0.08, "m/s", "of each hand while it draws", "choice: slow, so that the load is read in time"
    )
    timeout: float = quantity(
        6.0, "s", "of drawing, after which the width counts as it is", "choice: the hands are as far apart as they get"
    )
    min_load: float = quantity(
        0.8, "N", "on each hand; one that carries less has lost the gown", "choice: less than half of the gown's weight"
    )
    min_drawn: float = quantity(
        0.1, "m", "by which the hands draw apart before a lost gown is noticed", "choice: the gown swings at first"
    )
    settle_time: float = quantity(0.5, "s", "of rest in the end", "choice: the gown swings out")
    min_share: float = quantity(
        0.34,
        "1",
        "of what both hands carry then, on each; one that carries less holds no end of the neckline",
        "measured: 0.42 to 0.50 of 22 gowns held by both ends, 0.27 of one by an end and a hem, which became a rope on "
        "the bed (103)",
    )


class StretchNeckline(Skill):
    """Raises both hands before the chest and draws them apart until the cloth between them pulls back.

    It fails where a hand carries no cloth.  Where the least width is given, it fails too where the hands stay nearer
    together, and where one carries much less than the other: one of them then holds something else than an end.
    """

    max_load = Input(float, unit="N", doc="horizontal load on a hand at which the neckline is stretched", default=1.4)
    max_width = Input(float, unit="m", doc="greatest distance between the hands", default=0.92)
    min_width = Input(float, unit="m", doc="least distance between hands that hold both ends", default=0.0)
    tuning = Input(StretchNecklineTuning, default=StretchNecklineTuning(), doc="numbers of this skill")
    width = Output(float, unit="m", doc="distance between the hands in the end")
    reasons = (
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.COMMAND_LOST,
        Reason.CLOTH_SLIPPED,
        Reason.GRASP_MISSED,
    )

    def steps(self) -> Iterator[None]:
        """Raise, draw, settle."""
        tuning = self.tuning
        self.note("stretches the neckline")
        base = planar_pose(self.world.observe().pose_base_in_map)
        goals = {}
        for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
            pose = hand_now(self, side)
            pose[:3, 3] = (base @ np.array((tuning.distance, sign * tuning.half_width, tuning.height, 1.0)))[:3]
            goals[side] = pose
        yield from self._approach(move_hands(self, goals, speed=tuning.approach_speed, free="any", way="any"))
        end = self.now() + tuning.timeout
        outwards = {"left": base[:3, 1], "right": -base[:3, 1]}
        while True:
            width = self._apart()
            loads = {side: cloth_load(self, side) for side in SIDES}
            light = [side for side in SIDES if np.linalg.norm(loads[side]) < tuning.min_load]
            if light and width > 2 * tuning.half_width + tuning.min_drawn:
                raise SkillFailure(Reason.CLOTH_SLIPPED, f"the {light[0]} hand carries nothing")
            pulled = min(-loads[side] @ outwards[side] for side in SIDES)
            if self.now() > end or width > self.max_width or pulled > self.max_load:
                break
            for side in SIDES:
                twist = np.append(tuning.speed * outwards[side], np.zeros(3))
                self.world.send(HandTwist(side=side, twist_in_map=twist))
            yield
        self.world.stop()
        yield from self.wait(tuning.settle_time)
        if width < self.min_width:
            raise SkillFailure(
                Reason.GRASP_MISSED,
                f"stretched, the hands are {width:.2f} m apart, at least {self.min_width} m are asked for",
            )
        carried = [max(float(cloth_load(self, side) @ -UP), 0.0) for side in SIDES]
        if self.min_width and min(carried) < tuning.min_share * sum(carried):
            raise SkillFailure(
                Reason.GRASP_MISSED,
                f"the hands carry {carried[0]:.1f} and {carried[1]:.1f} N: one of them holds no end of the neckline",
            )
        self.width = width

    def _approach(self, motion: Iterator[None]) -> Iterator[None]:
        """Let the hands come before the chest; where that draws apart what is shorter, they stay where they are."""
        tuning = self.tuning
        for _ in motion:
            loads = [np.linalg.norm(cloth_load(self, side)) for side in SIDES]
            if max(loads) > tuning.approach_load and self._apart() < 2 * tuning.half_width:
                self.world.stop()
                yield from self.until(
                    self.context.guard.still, timeout=HANDS.stop_timeout, reason=Reason.MOTION_BLOCKED
                )
                return
            yield

    def _apart(self) -> float:
        """Distance between the hands [m]."""
        return float(np.linalg.norm(hand_now(self, "left")[:3, 3] - hand_now(self, "right")[:3, 3]))
