"""Look closely how both sleeves sit, with the hands' cameras beside the shoulders, from the head of the bed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from ....perception.errors import PerceptionFailure
from ....perception.estimates import ArmPosture, SleeveProfile
from ....perception.sleeve.sleeve_profile import reach_of, round_arm
from ....sim.quantity import Quantities, quantity
from ....sim.world import SIDES, Side
from ....skills.belief.close_look import CloseLook, SleeveSeen, sleeve_seen
from ....skills.belief.person_tracking import careful, watch_arm
from ....skills.control.hand_view import view_of
from ....skills.control.hands import move_arms, move_hands
from ....skills.control.head import look_towards
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason
from ....skills.core.skill import Skill
from ....skills.geometry.arm_path import UP
from ....skills.geometry.stances import HEADWARD, outwards
from ....skills.motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class LookAtSleevesTuning(Quantities):
    """From where both hands look."""

    eyes: tuple[tuple[float, float, float], ...] = quantity(
        ((0.35, 0.30, 0.12), (0.65, 0.15, 0.40)),
        "m",
        "of each hand's camera outwards, headward and up from the middle between the shoulders, one after the other",
        "measured: of 24 places that hands get to, the best two (141 states of eleven seeds): with the head's picture "
        "off by 0.026 of the upper arm (root mean square), with one of them by 0.032 and 0.040, with none by 0.052",
    )
    aimed_at: float = quantity(
        0.2, "1", "of the upper arm, from the shoulder, that is in the middle of the picture", "choice: the armhole"
    )
    min_pictures: int = quantity(2, "1", "that show an armhole, from which it is told", "choice: one shows half of it")
    speed: float = quantity(0.4, "m/s", "of the hands in the open", "choice: slow beside the person, as all motion is")
    settle_time: float = quantity(0.3, "s", "before the pictures", "choice: the hands come to rest")


class LookAtSleeves(Skill):
    """Sees with the head's and both hands' cameras how the sleeves sit; what nobody touched since, is known.

    One picture shows half of an armhole: its upper edge lies near the shoulder while its lower one may hang at the
    middle of the upper arm.  Each hand looks at the shoulder on its side.  Where no hand gets there, nothing is told.
    The robot stands at the head of the bed; the hands end in the ready posture.
    """

    tuning = Input(LookAtSleevesTuning, default=LookAtSleevesTuning(), doc="numbers of this skill")
    reasons = (Reason.ARM_LOST, Reason.MOTION_BLOCKED, Reason.UNREACHABLE, Reason.COMMAND_LOST)

    def steps(self) -> Iterator[None]:
        """Look, bring the hands there, look, bring them back."""
        if all(sleeve_seen(self, side) is not None for side in SIDES):
            yield
            return
        arms: dict[Side, ArmPosture] = {side: watch_arm(self, side) for side in SIDES}
        seen: dict[Side, list[SleeveProfile]] = {side: [] for side in SIDES}
        for arm in arms.values():
            yield from look_towards(self, arm.points_in_map[0])
            self._look("head", arm, seen)
        for eye in self.tuning.eyes:
            with suppress(MotionError):
                yield from move_hands(self, self._views(arms, eye), speed=careful(self, self.tuning.speed), way="any")
                yield from self.wait(self.tuning.settle_time)
                for side, arm in arms.items():
                    self._look(f"{side}_hand", arm, seen)
        yield from move_arms(self, self.world.robot.ready, speed=careful(self, self.tuning.speed))
        self._keep(seen)

    def _look(self, camera: str, arm: ArmPosture, seen: Mapping[Side, list[SleeveProfile]]) -> None:
        """Add what a camera sees of one armhole, if it does."""
        with suppress(PerceptionFailure):
            frame = self.world.look(camera)
            profile = self.context.senses.sleeve_profile(frame, side=arm.side, arm_in_map=arm.points_in_map)
            seen[arm.side].append(profile)

    def _views(self, arms: Mapping[Side, ArmPosture], eye: tuple[float, float, float]) -> dict[Side, np.ndarray]:
        """Pose (4, 4) of each hand whose camera is at `eye` from the middle between the shoulders [m]."""
        middle = np.mean([arm.points_in_map[0] for arm in arms.values()], axis=0)
        aside, headward, up = eye
        views: dict[Side, np.ndarray] = {}
        for side, arm in arms.items():
            shoulder, elbow = arm.points_in_map[:2]
            place = middle + aside * outwards(side) + headward * HEADWARD + up * UP
            views[side] = view_of(self.world.robot, side, shoulder + self.tuning.aimed_at * (elbow - shoulder), place)
        return views

    def _keep(self, seen: Mapping[Side, list[SleeveProfile]]) -> None:
        """What is known of both now."""
        known = CloseLook.of(self).sleeves
        for side, profiles in seen.items():
            if len(profiles) >= self.tuning.min_pictures:
                known[side] = SleeveSeen(reach_of(profiles), round_arm(profiles), self.now())
                CloseLook.of(self).before[side] = known[side]
        told = [f"{side} armhole {sat.reach:.2f}, cuff {sat.round_arm:.0%} round" for side, sat in known.items()]
        self.note(", ".join(told) or "too little of both armholes shows")
