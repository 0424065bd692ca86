"""A log as rows at a fixed rate: what a learner is shown at each of them, and what was done then."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..world import SIDES
from .robot_log import Picture, RobotLog, held

EARLY = 1e-6  # [s] by which a row may come before a measurement that belongs to it: rounding
POSITION, VELOCITY, EFFORT = 0, 1, 2  # columns of a joint in the log
BASE_AXES = ("x", "y", "yaw")


@dataclass(frozen=True, kw_only=True, eq=False)
class Feature:
    """One kind of number that every row has.

    Attributes:
        names: (n,) of its columns, each with what it is.
        values: (N, n) float32.
    """

    names: tuple[str, ...]
    values: np.ndarray


@dataclass(frozen=True, kw_only=True, eq=False)
class Episode:
    """One run at a fixed rate; row k is k / rate seconds after the first measurement.

    Attributes:
        robot: its name.
        features: by name.
        pictures: camera -> (N,) picture shown in each row; None before the first one.
    """

    robot: str
    features: dict[str, Feature]
    pictures: dict[str, list[Picture | None]]

    def __len__(self) -> int:
        """Rows."""
        return len(next(iter(self.features.values())).values)


def episode_of(log: RobotLog, rate: int) -> Episode:
    """What the robot had measured and seen last at each row, and what it was doing; nothing is taken from later.

    The action of an arm's joint and of the head is where it was one row later: hands move by twists too, which name no
    joint.  Those of grippers and base are what they were sent.

    Args:
        log: of the run.
        rate: rows a second [Hz].
    """
    count = 1 + int((log.t[-1] - log.t[0]) * rate + EARLY)
    t = log.t[0] + np.arange(count) / rate
    row = np.maximum(held(t + EARLY, log.t), 0)
    return Episode(
        robot=log.robot,
        features=_observed(log, row) | _acted(log, row, _Sent(log, t)),
        pictures={
            camera: [seen[k] if k >= 0 else None for k in held(t + EARLY, (picture.time for picture in seen))]
            for camera, seen in sorted(log.pictures.items())
            if seen[0].time <= t[-1]
        },
    )


def _observed(log: RobotLog, row: np.ndarray) -> dict[str, Feature]:
    arms, fingers, base = log.roles.arms, log.roles.fingers, log.roles.base
    squeezing = np.stack([_joints(log, row, pair, EFFORT).max(axis=1) for pair in fingers], axis=1)
    return {
        "observation.state": _feature(
            (_turned(log), _joints(log, row, (*arms, log.roles.head), POSITION)),
            (_of_grippers("opening"), _openings(log, row)),
            (_of_base("pos"), _joints(log, row, base, POSITION)),
        ),
        "observation.velocity": _feature(
            ([f"{name}.vel" for name in arms], _joints(log, row, arms, VELOCITY)),
            (_of_base("vel"), _known(log.twist_base)[row]),
        ),
        "observation.effort": _feature(
            ([f"{name}.effort" for name in arms], _joints(log, row, arms, EFFORT)), (_of_grippers("force"), squeezing)
        ),
        "observation.wrench": _feature((_of_hands("force", "torque"), _known(log.wrench_hand)[row])),
    }


def _acted(log: RobotLog, row: np.ndarray, sent: _Sent) -> dict[str, Feature]:
    later = np.append(row[1:], row[-1])
    return {
        "action": _feature(
            (_turned(log), _joints(log, later, (*log.roles.arms, log.roles.head), POSITION)),
            (_of_grippers("opening"), sent.openings(_openings(log, row))),
            (_of_base("vel"), sent.base()),
        ),
        "sent.hand_twist": _feature((_of_hands("linear", "angular"), sent.twists())),
    }


def _feature(*parts: tuple[list[str], np.ndarray]) -> Feature:
    """Columns beside each other, of names and values (N, ...) each."""
    values = [value.reshape(len(value), -1) for _, value in parts]
    return Feature(
        names=tuple(name for names, _ in parts for name in names),
        values=np.concatenate(values, axis=1).astype(np.float32),
    )


def _turned(log: RobotLog) -> list[str]:
    return [f"{name}.pos" for name in (*log.roles.arms, log.roles.head)]


def _of_grippers(what: str) -> list[str]:
    return [f"{side}_gripper.{what}" for side in SIDES]


def _of_base(what: str) -> list[str]:
    return [f"base.{axis}.{what}" for axis in BASE_AXES]


def _of_hands(*kinds: str) -> list[str]:
    return [f"{side}_hand.{kind}.{axis}" for side in SIDES for kind in kinds for axis in "xyz"]


def _joints(log: RobotLog, row: np.ndarray, names: Sequence[str], kind: int) -> np.ndarray:
    """(N, n) position, velocity or effort of joints."""
    return np.stack([_known(log.joints[name][:, kind])[row] for name in names], axis=1)


def _openings(log: RobotLog, row: np.ndarray) -> np.ndarray:
    """(N, 2) between the fingertips [m]: each finger goes half of it."""
    return np.stack([_joints(log, row, pair, POSITION).sum(axis=1) for pair in log.roles.fingers], axis=1)


def _known(values: np.ndarray) -> np.ndarray:
    """The same (T, ...), each number that is none as it was last known; 0 before it is known at all."""
    rows = np.arange(len(values)).reshape(-1, *(1,) * (values.ndim - 1))
    latest = np.maximum.accumulate(np.where(np.isfinite(values), rows, 0), axis=0)
    return np.nan_to_num(np.take_along_axis(values, latest, axis=0), posinf=0.0, neginf=0.0)


class _Sent:
    """What of the commands was in force at each of some times."""

    def __init__(self, log: RobotLog, t: np.ndarray) -> None:
        self._log, self._t = log, t

    def openings(self, measured: np.ndarray) -> np.ndarray:
        """(N, 2) opening that each gripper was last sent to [m]; as `measured` (N, 2) before."""
        found = [self._last(("GripperOpening",), side, "opening", measured[:, [n]]) for n, side in enumerate(SIDES)]
        return np.concatenate([values for values, _ in found], axis=1)

    def base(self) -> np.ndarray:
        """(N, 3) velocity that the base was to have [m/s, m/s, rad/s]."""
        return self._moving("BaseVelocity", None, "velocity", 3)

    def twists(self) -> np.ndarray:
        """(N, 12) velocity that each hand was to have in the map [m/s, rad/s]; 0 where it had none of this kind."""
        return np.concatenate([self._moving("HandTwist", side, "twist_in_map", 6) for side in SIDES], axis=1)

    def _moving(self, kind: str, side: str | None, field: str, width: int) -> np.ndarray:
        """Of commands that hold for their duration, until the next one or a stop."""
        nothing = np.zeros((len(self._t), width))
        values, until = self._last((kind, "stop"), side, field, nothing)
        return np.where((self._t < until - EARLY)[:, None], values, nothing)

    def _last(
        self, kinds: tuple[str, ...], side: str | None, field: str, before: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Of commands of these kinds: the field (N, n) of the last one, and until when it holds (N,) [s]."""
        those = [
            (time, content)
            for time, content in self._log.sent
            if content["command"] in kinds and content.get("side", side) == side
        ]
        index = held(self._t + EARLY, (time for time, _ in those))
        fields = np.zeros((len(those) + 1, before.shape[1]))  # one more, so that -1 is one too
        for k, (_, content) in enumerate(those):
            fields[k] = content.get(field, 0.0)  # a stop has none
        ends = np.array([time + content.get("duration", 0.0) for time, content in those] + [-np.inf])
        return np.where((index < 0)[:, None], before, fields[index]), ends[index]
