"""What a record says of the load on a hand and of the arm that it holds, and what the world predicts for it, kept."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from ....sim.effects.model_file import EffectEntry, EffectModel
from ....sim.known_robots import robot_named
from ....sim.mechanics.kinematics import kinematics_of
from ....sim.record.recorded_stretch import Stretch

CHANNELS = ("fx", "fy", "fz")  # load on the hand along the map's axes [N]
SEEN = ("wx", "wy", "wz")  # the held arm's wrist in the map, as it was seen last [m]
TURN = tuple(f"r{i}{k}" for i in range(3) for k in range(3))  # orientation of the hand in the map, row by row
CAMERA = tuple(f"c{i}{k}" for i in range(3) for k in range(3))  # the same of the head's camera when the arm was seen
TICKS = (
    4  # samples that are averaged, 0.27 s: the simulated robot's servo shakes a moved load by 0.5 N, faster than that
)
HAND = "hand"  # 0 left, 1 right
DELAY = "load_delay"
WRIST = 2  # of an arm's four points
SEEN_LOW = 0.0045  # by which wrists are seen below where they are, by all of eight records without any effect [m]


def columns_of(stretch: Stretch) -> dict[str, np.ndarray]:
    """Columns of an episode, (n,) each: means of every few of the samples that are looked at.

    `SEEN` and `CAMERA` are there where the arm was seen.
    """
    robot, hand = stretch.robot, stretch.hand
    out = {"t": robot.t.astype(float), HAND: np.full(len(robot.t), float(hand))}
    out |= dict(zip(CHANNELS, robot.wrench_hand[:, hand, :3].T, strict=True))
    turn = Rotation.from_quat(robot.pose_hand[:, hand, 3:]).as_matrix()
    out |= dict(zip(TURN, turn.reshape(-1, 9).T, strict=True))
    if (look := last_look(stretch)) is not None:
        out |= dict(zip(SEEN, robot.arm_points[look, WRIST].T, strict=True))
        kinematics, rows = kinematics_of(robot_named()), _rows_of(stretch, look)
        poses = [
            kinematics.pose_camera_in_map("head", robot.pose_base[k], robot.arm_positions[k], float(robot.head_pan[k]))
            for k in rows
        ]
        out |= dict(zip(CAMERA, np.array(poses)[:, :3, :3].reshape(-1, 9).T, strict=True))
    return {name: averaged(x, stretch.looked_at) for name, x in out.items()}


def last_look(stretch: Stretch) -> np.ndarray | None:
    """(T,) which of the looks at arms was the last one at the held one, for each sample; None where it was not seen.

    The first one counts for what was before it, too: the arm lies then.
    """
    robot, arm = stretch.robot, stretch.held_arm
    looks = np.flatnonzero((robot.arm_side == arm) & (robot.arm_t <= robot.t[-1]))
    if arm < 0 or not len(looks):
        return None
    return looks[np.clip(np.searchsorted(robot.arm_t[looks], robot.t, side="right") - 1, 0, None)]


def _rows_of(stretch: Stretch, look: np.ndarray) -> np.ndarray:
    """(T,) the sample at which each of these looks was taken."""
    return np.clip(np.searchsorted(stretch.robot.t, stretch.robot.arm_t[look]), 0, len(stretch.robot.t) - 1)


def averaged(x: np.ndarray, looked_at: np.ndarray) -> np.ndarray:
    """Means (n, ...) of (T, ...) over every `TICKS` samples in turn that are looked at (T,)."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], looked_at, [False]))))
    starts = [k for a, b in edges.reshape(-1, 2) for k in range(a, b - TICKS + 1, TICKS)]
    return x[np.add.outer(starts, range(TICKS))].mean(axis=1)


class Predictions:
    """What the dressing world has for stretches of records, each asked for once.

    Args:
        cache: folder for what was simulated; None keeps it in memory alone.
    """

    def __init__(self, cache: Path | None = None) -> None:
        self._cache = cache
        self._kept: dict[str, np.ndarray] = {}
        self.simulated = 0

    def of(self, stretch: Stretch, effects: tuple[EffectEntry, ...], drag: float = 0.0) -> np.ndarray:
        """(n, 6) load on the hand [N] and wrist of the held arm [m], 0 where none is, in the rows of `columns_of`.

        Args:
            stretch: of a record.
            effects: on the dressing world.
            drag: of the closing fingers, see `replayed` [m].

        Raises:
            CaretreeError: the effects cannot be loaded into this world.
        """
        delay = sum(e.parameters["delay"] for e in effects if e.name == DELAY)
        world = tuple(e for e in effects if e.name != DELAY)
        key = _key(stretch, world, drag)
        if key not in self._kept:
            self._kept[key] = self._found(stretch, world, drag, key)
        load, arms = self._kept[key][:, :3], self._kept[key][:, 3:]
        if delay:
            t = stretch.robot.t
            load = np.stack([np.interp(t - delay, t, x) for x in load.T], axis=1)
        if (look := last_look(stretch)) is not None:
            arms = arms[_rows_of(stretch, look)] - (0.0, 0.0, SEEN_LOW)
        return averaged(np.hstack((load, arms)), stretch.looked_at)

    def _found(self, stretch: Stretch, effects: tuple[EffectEntry, ...], drag: float, key: str) -> np.ndarray:
        """(T, 6) load and wrist at all samples, from where they are kept."""
        file = None if self._cache is None else self._cache / f"{key}.npy"
        if file is not None and file.is_file():
            try:
                return np.load(file, allow_pickle=False)
            except (OSError, ValueError, EOFError):
                file.unlink()  # cut short
        from ....sim.bullet.replay_world import replayed  # the physics, only where something is simulated

        model = EffectModel(system="dressing", base={}, recalibration=(), effects=effects)
        answer = replayed(stretch, model if effects else None, drag)
        wrist = answer.arms[:, max(stretch.held_arm, 0), WRIST] * float(stretch.held_arm >= 0)
        found = np.hstack((answer.load[:, stretch.hand], wrist))
        self.simulated += 1
        if file is not None:
            file.parent.mkdir(parents=True, exist_ok=True)
            part = file.with_suffix(".part")
            with part.open("wb") as out:
                np.save(out, found)
            part.replace(file)
        return found


def _key(stretch: Stretch, effects: tuple[EffectEntry, ...], drag: float) -> str:
    """Of what is asked for: the same samples, the same hand, the same effects and drag."""
    digest = hashlib.sha256()
    robot = stretch.robot
    for array in (robot.t, robot.arm_positions, stretch.held.part, stretch.arms):
        digest.update(np.ascontiguousarray(array).tobytes())
    said: list[tuple[str, str, Mapping[str, float]]] = [(e.name, e.target, e.parameters) for e in effects]
    asked = [stretch.scene.seed, stretch.hand, stretch.gown, stretch.person, said, drag]
    digest.update(json.dumps(asked).encode())
    return digest.hexdigest()[:24]
