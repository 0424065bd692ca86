"""A constant-velocity Kalman filter on the four joint centres of an arm whose limbs keep their lengths."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...sim.quantity import Quantities, quantity
from .arm_fit import ChainFit, length_rows, point_along, span_row, turned_about_shoulder
from .person_facts import PERSON

_JOINTS = 12  # coordinates of shoulder, elbow, wrist and fingertip; as many velocities follow them in the state


@dataclass(frozen=True, kw_only=True)
class ArmFilterTuning(Quantities):
    """Numbers of the filter."""

    motion_decay: float = quantity(0.4, "s", "after which a motion has died out", "choice: nobody swings this arm")
    start_speed: float = quantity(
        0.02, "m/s", "of the joints when the filter starts, standard deviation", "choice: an arm at rest, or nearly"
    )
    fit_deviation: float = quantity(
        0.004, "m", "of a fit beyond its own covariance", "choice: neighbouring points share their error"
    )
    prediction_deviation: float = quantity(
        0.006, "m", "of a fit from the prediction beyond both covariances", "choice: as that of lengths"
    )
    length_deviation: float = quantity(0.006, "m", "of the limbs' lengths", "choice: joint centres move in the flesh")
    turning_distance: float = quantity(
        0.05,
        "m",
        "of a held point from where it is expected, beyond which the whole arm turns at once",
        "choice: the filter is no longer linear there",
    )
    twist: float = quantity(
        0.2, "1", "of a turned joint's way that is not known", "choice: an arm may twist about its axis as it is turned"
    )
    jump: float = quantity(
        0.05,
        "m",
        "of the joints, standard deviation, where several fits in turn say that they moved",
        "choice: an arm's width",
    )


DEFAULT = ArmFilterTuning()


class ArmFilter:
    """Joints of one arm over time, from the first fit on.

    Attributes:
        time: world clock of the state [s].
    """

    def __init__(self, fit: ChainFit, time: float, tuning: ArmFilterTuning = DEFAULT) -> None:
        """Start where a fit says that the arm is.

        Args:
            fit: of the arm.
            time: world clock of its image [s].
            tuning: numbers.
        """
        from filterpy.kalman import KalmanFilter

        self.time = time
        self._tuning = tuning
        self._filter: Any = KalmanFilter(dim_x=2 * _JOINTS, dim_z=_JOINTS)
        self._filter.x = np.concatenate([fit.joints.ravel(), np.zeros(_JOINTS)])
        self._filter.P = np.zeros((2 * _JOINTS, 2 * _JOINTS))
        self._filter.P[:_JOINTS, :_JOINTS] = fit.covariance + np.eye(_JOINTS) * tuning.fit_deviation**2
        self._filter.P[_JOINTS:, _JOINTS:] = np.eye(_JOINTS) * tuning.start_speed**2

    @property
    def joints(self) -> np.ndarray:
        """Shoulder, elbow, wrist and fingertip (4, 3) [m]."""
        return self._filter.x[:_JOINTS].reshape(4, 3).copy()

    @property
    def deviation(self) -> np.ndarray:
        """Standard deviation (4,) of each joint in its worst direction of the axes [m]."""
        return np.sqrt(np.maximum(np.diag(self._filter.P)[:_JOINTS], 1e-8).reshape(4, 3).max(axis=1))

    def predict(self, time: float, speed: float) -> None:
        """Go on to `time` [s]; the joints may move at `speed`, standard deviation [m/s]."""
        step, decay = time - self.time, self._tuning.motion_decay
        if step <= 0:
            return
        self.time = time
        fade = math.exp(-step / decay)
        travel = decay * (1 - fade)
        transition = np.eye(2 * _JOINTS)
        transition[:_JOINTS, _JOINTS:] = travel * np.eye(_JOINTS)
        transition[_JOINTS:, _JOINTS:] = fade * np.eye(_JOINTS)
        noise = np.zeros((2 * _JOINTS, 2 * _JOINTS))
        noise[_JOINTS:, _JOINTS:] = np.eye(_JOINTS) * speed**2 * (1 - fade**2)
        noise[:_JOINTS, :_JOINTS] = np.eye(_JOINTS) * 2 * speed**2 * decay * step * (1 - (1 - fade) * decay / step)
        self._filter.F, self._filter.Q = transition, noise
        self._filter.predict()

    def turn_to(self, point: np.ndarray, arm_coordinate: float) -> None:
        """Turn the arm about its shoulder as one piece until a coordinate of it points at (3,) [m].

        A filter that is told of an elbow far from where it was leaves the hand behind.
        """
        joints = self.joints
        if np.linalg.norm(point - point_along(joints, arm_coordinate)) < self._tuning.turning_distance:
            return
        turned = turned_about_shoulder(joints, arm_coordinate, point)
        moved = np.linalg.norm(turned - joints, axis=1)
        self._filter.x[:_JOINTS] = turned.ravel()
        self._filter.P[:_JOINTS, :_JOINTS] += np.diag(np.repeat((self._tuning.twist * moved) ** 2, 3))

    def surprise(self, fit: ChainFit) -> float:
        """Squared Mahalanobis distance between a fit and the prediction."""
        gap = fit.joints.ravel() - self._filter.x[:_JOINTS]
        spread = self._filter.P[:_JOINTS, :_JOINTS] + fit.covariance
        return float(gap @ np.linalg.solve(spread + np.eye(_JOINTS) * self._tuning.prediction_deviation**2, gap))

    def admit_jump(self) -> None:
        """The joints may have moved since they were seen, however still they should be."""
        self._filter.P[:_JOINTS, :_JOINTS] += np.eye(_JOINTS) * self._tuning.jump**2

    def take_fit(self, fit: ChainFit) -> None:
        """Take the joints of a fit into account."""
        covariance = fit.covariance + np.eye(_JOINTS) * self._tuning.fit_deviation**2
        self._measure(fit.joints.ravel(), np.eye(_JOINTS), covariance)

    def take_point(self, point: np.ndarray, arm_coordinate: float, deviation: float) -> None:
        """The axis passes through a point (3,) at a coordinate, known with a standard `deviation` [m]."""
        segment = min(int(arm_coordinate), 2)
        share = float(np.clip(arm_coordinate - segment, 0.0, 1.0))
        rows = np.zeros((3, _JOINTS))
        rows[:, 3 * segment : 3 * segment + 3] = (1 - share) * np.eye(3)
        rows[:, 3 * segment + 3 : 3 * segment + 6] = share * np.eye(3)
        self._measure(point, rows, np.eye(3) * deviation**2)

    def take_lengths(self, lengths: np.ndarray, span: float | None) -> None:
        """Limbs do not stretch: their lengths (3,), and the span from shoulder to wrist if known, are measured [m]."""
        rows, sizes = length_rows(self.joints)
        covariance = np.eye(3) * self._tuning.length_deviation**2
        self._measure(lengths - sizes + rows @ self._filter.x[:_JOINTS], rows, covariance)
        if span is not None:
            row, reach = span_row(self.joints)
            self._measure(span - reach + row @ self._filter.x[:_JOINTS], row, np.eye(1) * PERSON.span_deviation**2)

    def _measure(self, value: np.ndarray, rows: np.ndarray, covariance: np.ndarray) -> None:
        full = np.zeros((len(value), 2 * _JOINTS))
        full[:, :_JOINTS] = rows
        self._filter.update(value, R=covariance, H=full)
        self._filter.P = (self._filter.P + self._filter.P.T) / 2
