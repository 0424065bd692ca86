"""What a record says of the load on a hand: the columns of an episode, and what the world predicts for them, kept."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from ....sim.effects.model_file import EffectEntry, EffectModel
from ....sim.record.recorded_stretch import Stretch

CHANNELS = ("fx", "fy", "fz")  # load on the hand along the map's axes [N]
TURN = tuple(f"r{i}{k}" for i in range(3) for k in range(3))  # orientation of the hand in the map, row by row
TICKS = (
    4  # samples that are averaged, 0.27 s: the simulated robot's servo shakes a moved load by 0.5 N, faster than that
)
HAND = "hand"  # 0 left, 1 right


def columns_of(stretch: Stretch) -> dict[str, np.ndarray]:
    """Columns of an episode, (n,) each: means of every few of the samples that are looked at."""
    rows, hand = stretch.looked_at, stretch.hand
    load = stretch.robot.wrench_hand[rows, hand, :3]
    turn = Rotation.from_quat(stretch.robot.pose_hand[rows, hand, 3:]).as_matrix().reshape(-1, 9)
    out = {"t": stretch.robot.t[rows].astype(float), HAND: np.full(len(load), float(hand))}
    out |= dict(zip(CHANNELS, load.T, strict=True)) | dict(zip(TURN, turn.T, strict=True))
    return {name: averaged(x) for name, x in out.items()}


def averaged(x: np.ndarray) -> np.ndarray:
    """Means (n, ...) of every `TICKS` samples of (T, ...)."""
    n = len(x) // TICKS
    return x[: n * TICKS].reshape(n, TICKS, *x.shape[1:]).mean(axis=1)


class LoadPredictions:
    """What the dressing world has for stretches of records, each asked for once.

    Args:
        cache: folder for what was simulated; None keeps it in memory alone.
    """

    def __init__(self, cache: Path | None = None) -> None:
        self._cache = cache
        self._kept: dict[str, np.ndarray] = {}
        self.simulated = 0

    def load(self, stretch: Stretch, effects: tuple[EffectEntry, ...]) -> np.ndarray:
        """(n, 3) load on the hand where `columns_of` has its rows [N].

        Args:
            stretch: of a record.
            effects: on the dressing world.

        Raises:
            CaretreeError: the effects cannot be loaded into this world.
        """
        key = _key(stretch, effects)
        if key not in self._kept:
            self._kept[key] = averaged(self._found(stretch, effects, key))
        return self._kept[key]

    def _found(self, stretch: Stretch, effects: tuple[EffectEntry, ...], key: str) -> np.ndarray:
        file = None if self._cache is None else self._cache / f"{key}.npy"
        if file is not None and file.is_file():
            try:
                return np.load(file, allow_pickle=False)
            except (OSError, ValueError, EOFError):
                file.unlink()  # cut short
        from ....sim.bullet.replay_world import replayed  # the physics, only where something is simulated

        model = EffectModel(system="dressing", base={}, recalibration=(), effects=effects)
        load = replayed(stretch, model if effects else None).load[stretch.looked_at, stretch.hand]
        self.simulated += 1
        if file is not None:
            file.parent.mkdir(parents=True, exist_ok=True)
            part = file.with_suffix(".part")
            with part.open("wb") as out:
                np.save(out, load)
            part.replace(file)
        return load


def _key(stretch: Stretch, effects: tuple[EffectEntry, ...]) -> str:
    """Of what is asked for: the same samples, the same hand, the same effects."""
    digest = hashlib.sha256()
    robot = stretch.robot
    for array in (robot.t, robot.arm_positions, stretch.held.part, stretch.arms, stretch.looked_at):
        digest.update(np.ascontiguousarray(array).tobytes())
    said: list[tuple[str, str, Mapping[str, float]]] = [(e.name, e.target, e.parameters) for e in effects]
    digest.update(json.dumps([stretch.scene.seed, stretch.hand, stretch.gown, stretch.person, said]).encode())
    return digest.hexdigest()[:24]
