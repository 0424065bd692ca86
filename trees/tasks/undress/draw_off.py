"""Draw a sleeve off a lying arm by its seam, past the fingertips, and lay it down."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from ....perception.image.cloud import unit
from ....sim.quantity import Quantities, quantity
from ....sim.world import Side
from ....skills.belief.person_tracking import watch_arm
from ....skills.control.base import drive_to
from ....skills.control.carry import Carry, carry
from ....skills.control.fingers import open_gripper
from ....skills.control.hands import cloth_load, hand_now, until_load
from ....skills.control.withdraw import withdraw
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason, SkillFailure
from ....skills.core.skill import Skill
from ....skills.geometry.stances import HEADWARD


@dataclass(frozen=True, kw_only=True)
class DrawOffTuning(Quantities):
    """Numbers of `DrawOff`."""

    speed: float = quantity(
        0.13, "m/s", "of the base while the sleeve is drawn", "choice: just below what the guard allows a hand there"
    )
    max_load: float = quantity(
        9.0, "N", "of the sleeve, at which it counts as caught", "measured: ideal hands drew it off with at most 4.4 N"
    )
    past: float = quantity(
        0.28,
        "m",
        "beyond the fingertips along the hand, where the whole armhole is off it",
        "measured: it lagged 0.15 m behind the seam with ideal hands, 0.24 m where it was taken farther out (100)",
    )
    min_load: float = quantity(0.3, "N", "of a sleeve that is held there", "choice: it pulled with 2 to 5 N")
    arrived: float = quantity(
        0.05, "m", "from its end, within which the hand has come there", "choice: half of a hand's width"
    )
    inside: float = quantity(
        0.12, "m", "from the edge of the mattress, where the sleeve is laid down", "choice: it does not slip off"
    )
    laid: float = quantity(0.15, "m", "above the mattress, where it is let go of", "choice: above hand and thigh")
    carry: Carry = field(default_factory=lambda: Carry(speed=0.10, max_load=9.0))
    opening: float = quantity(0.05, "m", "of the fingers that let it go", "choice: just enough; they are near the legs")
    withdrawal: float = quantity(0.15, "m", "by which the open hand is drawn back", "choice: clear of the sleeve")


class DrawOff(Skill):
    """Drives so that the hand goes above elbow, wrist, fingertips and beyond, then in over the bed; lays the seam down.

    The hand stays where it is before the robot, the base does the way: it is as long as the arm.  A sleeve that pulls
    hard is caught, and is drawn no farther.
    """

    side = Input(Side, doc="of the person")
    hand = Input(Side, doc="hand of the robot that holds the seam")
    beyond = Input(float, unit="m", default=0.3, doc="footward of the fingertips, where the seam is laid down")
    tuning = Input(DrawOffTuning, default=DrawOffTuning(), doc="numbers of this skill")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.SLEEVE_CAUGHT,
        Reason.CLOTH_SLIPPED,
        Reason.PATH_BLOCKED,
        Reason.MOTION_BLOCKED,
        Reason.TIMEOUT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Along the arm, beyond it, down, let go."""
        tuning = self.tuning
        self.note(f"draws the sleeve off the {self.side} arm")
        arm = watch_arm(self, self.side).points_in_map
        (least, _, _), (most, _, top) = self.world.room.bed
        end = arm[3] - self.beyond * HEADWARD
        end[0] = np.clip(end[0], least + tuning.inside, most - tuning.inside)
        past = arm[3] + tuning.past * unit(arm[3] - arm[2])
        yield from self._above([*arm[1:], past, end])
        here = hand_now(self, self.hand)[:3, 3]
        yield from carry(self, self.hand, np.append(here[:2], top + tuning.laid), tuning.carry)
        yield from open_gripper(self, self.hand, tuning.opening)
        yield from withdraw(self, [self.hand], tuning.withdrawal)

    def _above(self, places: Sequence[np.ndarray]) -> Iterator[None]:
        """Along above places (3,), as long as the sleeve comes along and is held."""
        tuning = self.tuning
        pose = self.world.observe().pose_base_in_map
        ways = np.array(places)[:, :2] - hand_now(self, self.hand)[:2, 3]
        draws = drive_to(
            self, pose + np.append(ways[-1], 0.0), straight=True, via=list(pose[:2] + ways[:-1]), speed=tuning.speed
        )
        yield from until_load(self, self.hand, tuning.max_load, draws)
        left = float(np.linalg.norm((places[-1] - hand_now(self, self.hand)[:3, 3])[:2]))
        load = float(np.linalg.norm(cloth_load(self, self.hand)))
        if left > tuning.arrived:
            raise SkillFailure(Reason.SLEEVE_CAUGHT, f"{left:.2f} m before its end it pulls with {load:.1f} N")
        if load < tuning.min_load:
            raise SkillFailure(Reason.CLOTH_SLIPPED, f"{load:.1f} N hang on the {self.hand} hand")
