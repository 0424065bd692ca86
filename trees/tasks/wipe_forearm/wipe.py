"""Wipe along the person's forearm with a cloth that is pressed on with a given force."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ....perception.image.cloud import unit
from ....sim.quantity import Quantities, quantity
from ....sim.world import SIDES, HandTwist, Side
from ....skills.belief.person_tracking import watch_arm
from ....skills.control.arm_grip import top_down_reachable
from ....skills.control.hands import cloth_load, hand_now, move_hands
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason, SkillFailure
from ....skills.core.skill import Skill
from ....skills.geometry.arm_path import UP, ArmPath
from ....skills.motion.ik import hand_pose


@dataclass(frozen=True, kw_only=True)
class WipeTuning(Quantities):
    """Numbers of `Wipe`."""

    ends: tuple[float, float] = quantity(
        (1.85, 1.15),
        "1",
        "arm coordinates of a stroke: 1 elbow, 2 wrist",
        "choice: all but the joints; from the wrist, which sinks onto the bed first",
    )
    force: float = quantity(3.5, "N", "with which the cloth is pressed on", "design requirement: between 2 and 5 N")
    hover: float = quantity(
        0.13, "m", "of the fingertips off the arm's axis before", "choice: the cloth clears the arm"
    )
    speed: float = quantity(0.06, "m/s", "along the arm", "choice: as a nurse washes who takes care")
    lowering_speed: float = quantity(0.03, "m/s", "until the cloth touches", "choice: 1 N more in 70 ms")
    touch: float = quantity(1.0, "N", "at which the cloth touches the arm", "choice: four times the sensor's noise")
    settled: float = quantity(
        0.7, "N", "off the wanted force before the first stroke", "choice: half of what is allowed"
    )
    settling_time: float = quantity(6.0, "s", "for the force to settle", "choice: an arm gives way by 3 cm meanwhile")
    lowest: float = quantity(0.03, "m", "of the fingertips off the arm's axis", "choice: a cloth that is not there")
    gain: float = quantity(0.006, "m/s/N", "speed off the arm for each newton too much", "choice: settles within 0.5 s")
    max_pressing: float = quantity(0.03, "m/s", "greatest speed off and onto the arm", "choice: as it is lowered")
    steering: float = quantity(1.5, "1/s", "gain of the correction across the arm", "choice: slower than a tick")
    weighing_time: float = quantity(0.6, "s", "over which the cloth is weighed before", "choice: nine samples")
    max_force: float = quantity(8.0, "N", "that ends it", "design requirement: the guard slows a hand from there")
    timeout_factor: float = quantity(2.5, "1", "of the time of a stroke", "choice: room for a guard that slows it down")
    lift: float = quantity(0.12, "m", "by which the cloth is lifted off in the end", "choice: clear of the arm")


class Wipe(Skill):
    """Brings the cloth over the forearm, lowers it until it touches, and moves it to and fro with an even force.

    It fails where the arm is not seen or out of reach, where nothing is touched, and where the force gets too large.
    """

    side = Input(Side, doc="arm of the person")
    hand = Input(Side, doc="hand of the robot that holds the cloth")
    strokes = Input(int, doc="ways along the forearm, to and fro")
    tuning = Input(WipeTuning, default=WipeTuning(), doc="numbers of this skill")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.CLOTH_SLIPPED,
        Reason.FORCE_LIMIT,
        Reason.TIMEOUT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Over the arm, weigh, down, to and fro, up."""
        tuning = self.tuning
        self.note(f"wipes the {self.side} forearm")
        self._path = ArmPath.of(watch_arm(self, self.side, period=0.0))
        self._axis = unit(self._path.point(2.0) - self._path.point(1.0))
        self._off = unit(UP - (UP @ self._axis) * self._axis)
        yield from self._go_over(tuning.ends[0])
        yield from self._weigh()
        yield from self._touch()
        for n in range(self.strokes):
            self.note(f"stroke {n + 1} of {self.strokes}")
            yield from self._stroke(tuning.ends[(n + 1) % 2])
        up = hand_now(self, self.hand)
        up[:3, 3] += tuning.lift * self._off
        yield from move_hands(self, {self.hand: up}, retreat=True)

    def _go_over(self, coordinate: float) -> Iterator[None]:
        """Fingers pointing at the arm, side by side along it: the cloth between them lies across it."""
        place = self._path.point(coordinate) + self.tuning.hover * self._off
        pose = hand_pose(place, -self._off, self._axis)
        yield from move_hands(self, {self.hand: top_down_reachable(self, self.hand, pose)}, way="either")

    def _weigh(self) -> Iterator[None]:
        samples, end = [], self.now() + self.tuning.weighing_time
        while self.now() < end:
            samples.append(cloth_load(self, self.hand))
            yield
        self._weight = np.mean(samples, axis=0)

    def _pressed(self) -> float:
        """Force of the arm on the cloth, off the arm [N].

        Raises:
            SkillFailure: FORCE_LIMIT when it is too large.
        """
        force = float((cloth_load(self, self.hand) - self._weight) @ self._off)
        if force > self.tuning.max_force:
            raise SkillFailure(Reason.FORCE_LIMIT, f"{force:.1f} N on the {self.side} forearm")
        return force

    def _height(self) -> float:
        """Of the fingertips off the arm's axis [m]."""
        return float((hand_now(self, self.hand)[:3, 3] - self._path.point(1.0)) @ self._off)

    def _send(self, velocity: np.ndarray) -> None:
        self.world.send(HandTwist(side=self.hand, twist_in_map=np.append(velocity, np.zeros(3))))

    def _touch(self) -> Iterator[None]:
        while self._pressed() < self.tuning.touch:
            if self._height() < self.tuning.lowest:
                raise SkillFailure(Reason.CLOTH_SLIPPED, "there is no cloth between the hand and the arm")
            self._send(-self.tuning.lowering_speed * self._off)
            yield
        until = self.now() + self.tuning.settling_time
        while abs(self._pressed() - self.tuning.force) > self.tuning.settled and self.now() < until:
            self._send(-self._pressing() * self._off)
            yield

    def _pressing(self) -> float:
        """Speed onto the arm by which the force comes nearer to the wanted one [m/s]."""
        tuning = self.tuning
        speed = tuning.gain * (tuning.force - self._pressed())
        return float(np.clip(speed, -tuning.max_pressing, tuning.max_pressing))

    def _stroke(self, goal: float) -> Iterator[None]:
        """Along the arm to an arm coordinate; off and onto it by the force; back over its axis by what is seen."""
        tuning, end = self.tuning, self._path.point(goal)
        across = np.cross(self._axis, self._off)
        rest = (end - hand_now(self, self.hand)[:3, 3]) @ self._axis
        way, until = np.sign(rest), self.now() + tuning.timeout_factor * abs(rest) / tuning.speed + 1.0
        while way * rest > 0.0:
            if self.now() > until:
                raise SkillFailure(Reason.TIMEOUT, f"{abs(rest):.2f} m of a stroke are left")
            here = self.world.observe().pose_hand_in_map[SIDES.index(self.hand), :3, 3]
            aside = (end - here) @ across
            self._send(
                way * tuning.speed * self._axis - self._pressing() * self._off + tuning.steering * aside * across
            )
            yield
            rest = (end - hand_now(self, self.hand)[:3, 3]) @ self._axis
