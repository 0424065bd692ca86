"""The arc on which a hand swings an arm about its shoulder; by giving way, the hand finds the true circle."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ...perception.image.cloud import unit
from ...sim.quantity import Quantities, quantity
from ..geometry.arm_path import UP
from .give_way import GiveWay, GiveWayTuning


@dataclass(frozen=True, kw_only=True)
class ArcTuning(Quantities):
    """How a hand on an arc gives way to a pull across it."""

    dead_band: float = quantity(3.0, "N", "pull across the arc that is borne", "choice: above the noise of the force")
    friction: float = quantity(
        12.0,
        "N",
        "pull square to the arm and the arc that is borne",
        "measured: at an elbow 0.28 m from its shoulder the joint that turns outwards resists with 8.6 N by friction; "
        "given way to above 3 N, no arm of ten runs was spread at all",
    )
    max_offset: float = quantity(
        0.08,
        "m",
        "greatest way that the hand gives",
        "choice: the shoulder is a few cm from where it was seen",
    )
    give_way: GiveWayTuning = field(default_factory=GiveWayTuning)


ARC = ArcTuning()


class Arc:
    """The great circle about the shoulder from where the hand holds the arm to where the arm is to point.

    The arm turns about its own shoulder, which is a few centimetres from where it was seen.  So a pull along the arm
    does not come from its weight: the hand is on a wrong circle, and gives way.  A pull square to arm and arc is the
    friction of a joint, each of which resists with all it has, however small its share of the turn: it is borne.

    Args:
        shoulder: (3,) centre as it was seen [m].
        start: (3,) where the hand holds the arm [m].
        goal: (3,) unit vector from the shoulder to where the hand is to bring the arm.
        reach: from the shoulder to the hand in the end [m], where the arm is straightened on the way; None to keep it.
        tuning: how it gives way.

    Attributes:
        radius: of the circle where it starts [m].
        angle: from start to goal [rad].
        axis: (3,) unit vector about which the arm turns.
        offset: (3,) how far the hand has given way so far [m].
    """

    def __init__(
        self,
        shoulder: np.ndarray,
        start: np.ndarray,
        goal: np.ndarray,
        *,
        reach: float | None = None,
        tuning: ArcTuning = ARC,
    ) -> None:
        self._tuning, self._gives = tuning, GiveWay(tuning.give_way)
        self._shoulder = np.asarray(shoulder, float)
        arm = np.asarray(start, float) - self._shoulder
        self.radius = float(np.linalg.norm(arm))
        self._first = arm / self.radius
        self.angle = math.acos(np.clip(self._first @ goal, -1.0, 1.0))
        across = np.cross(self._first, goal)
        self.axis = unit(across if np.linalg.norm(across) > 1e-9 else np.cross(self._first, UP))
        self.offset = np.zeros(3)
        self._growth = 0.0 if reach is None else (reach - self.radius) / max(self.angle, 1e-9)  # [m/rad]

    def at(self, swung: float) -> tuple[np.ndarray, np.ndarray]:
        """Point (3,) [m] of the arc `swung` [rad] from the start, and the unit direction (3,) of the swing there."""
        arm, tangent = self._directions(swung)
        return self._shoulder + self._radius_at(swung) * arm, tangent

    def velocity(self, swung: float, rate: float) -> np.ndarray:
        """Velocity (3,) of the hand on the arc at that place, where it swings on at a `rate` [rad/s] [m/s]."""
        arm, tangent = self._directions(swung)
        return rate * self._radius_at(swung) * tangent + rate * self._growth * arm

    def _directions(self, swung: float) -> tuple[np.ndarray, np.ndarray]:
        """Unit vectors (3,) along the arm and along the swing."""
        onwards = np.cross(self.axis, self._first)
        arm = math.cos(swung) * self._first + math.sin(swung) * onwards
        return arm, -math.sin(swung) * self._first + math.cos(swung) * onwards

    def _radius_at(self, swung: float) -> float:
        return self.radius + self._growth * swung

    def give_way(self, load: np.ndarray, tangent: np.ndarray, now: float, step: float) -> np.ndarray:
        """Velocity (3,) [m/s] across the arc under a load (3,) [N]; moves `offset` on by `step` [s] of it."""
        square = (load @ self.axis) * self.axis
        along = load - (load @ tangent) * tangent - square
        pull = _beyond(along, self._tuning.dead_band) + _beyond(square, self._tuning.friction)
        velocity = self._gives.velocity(pull, now)
        self.offset = self.offset + velocity * step
        self.offset *= min(1.0, self._tuning.max_offset / max(float(np.linalg.norm(self.offset)), 1e-9))
        return velocity


def _beyond(pull: np.ndarray, borne: float) -> np.ndarray:
    """What is left of a pull (3,) of which so much is borne [N]."""
    return pull * max(0.0, 1.0 - borne / max(float(np.linalg.norm(pull)), 1e-9))
