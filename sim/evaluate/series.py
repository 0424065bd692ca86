"""What happened over a run as curves over time, for people to look at."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import RecordError
from ..world import SIDES
from .arrays_file import read_arrays
from .clearance import clearance
from .harm import wrists_above_bed
from .plausibility import motion
from .truth_file import Truth, read_truth
from .unharmed_rows import UnharmedRows
from .verdict import sleeves_of

CHUNK = 256  # frames looked at in one go, to bound memory
SPEED_WINDOW = 3  # frames over which a hand's speed is averaged: one frame alone shows rounding


@dataclass(frozen=True, kw_only=True)
class Series:
    """Curves of one run; those of the gown are not a number where the task has none.

    Attributes:
        t: (T,) world clock [s].
        load: (T, 2) cloth load on the left and right gripper [N].
        holds: (T, 2) bool, gripper holds cloth.
        person_force: (T, k) force on each body part [N].
        person_parts: (k,) their names.
        distance: (T, 2) from each hand to the nearest of the person's arms and torso [m].
        speed: (T, 2) of each hand [m/s].
        upper_arm: (T, 2) way of the left and right armhole up the upper arm, 0 elbow or off, 1 shoulder.
        stretch_p99: (T,) 99th percentile of edge length over rest length.
        stretch_max: (T,) longest edge over its rest length.
        clearance: (T, 2) from the nearest link of the robot to head and neck, and to the rest of the body [m], negative
            inside; None where the record does not tell.
        wrists: (T, 2) height of the left and right wrist above the mattress [m]; None where the record does not tell.
    """

    t: np.ndarray
    load: np.ndarray
    holds: np.ndarray
    person_force: np.ndarray
    person_parts: tuple[str, ...]
    distance: np.ndarray
    speed: np.ndarray
    upper_arm: np.ndarray
    stretch_p99: np.ndarray
    stretch_max: np.ndarray
    clearance: np.ndarray | None = None
    wrists: np.ndarray | None = None


def read_series(directory: Path) -> Series:
    """The curves of the record in `directory`.

    Raises:
        RecordError: the record is missing or damaged.
    """
    truth = read_truth(directory, gown=False)
    extra = read_arrays(directory, ("gripper_pose", "person_force", "person_parts"))
    shapes = {"gripper_pose": (len(truth.t), 2, 7), "person_force": (len(truth.t), len(extra["person_parts"]))}
    for name, shape in shapes.items():
        if extra[name].shape != shape:
            raise RecordError(f"{directory}: {name} has shape {extra[name].shape}, but {shape} is asked for")
    hands = extra["gripper_pose"][:, :, :3].astype(np.float64)
    with np.errstate(invalid="ignore"):  # a record of broken physics is drawn with gaps
        p99, longest = _stretch(truth)
        return Series(
            t=truth.t,
            load=np.linalg.norm(truth.gripper_load.astype(np.float64), axis=2),
            holds=truth.gripper_closed.astype(bool),
            person_force=extra["person_force"],
            person_parts=tuple(str(name) for name in extra["person_parts"]),
            distance=_distance(truth, hands),
            speed=_speed(truth.t, hands),
            upper_arm=_upper_arm(truth) if truth.has_gown else np.full((len(truth.t), 2), np.nan),
            stretch_p99=p99,
            stretch_max=longest,
            clearance=None if truth.unharmed is None else _clearance(truth, truth.unharmed),
            wrists=None if truth.unharmed is None else wrists_above_bed(truth, truth.unharmed),
        )


def _chunks(count: int) -> list[np.ndarray]:
    return [np.arange(first, min(first + CHUNK, count)) for first in range(0, count, CHUNK)]


def _stretch(truth: Truth) -> tuple[np.ndarray, np.ndarray]:
    """(T,) 99th percentile and longest of the gown's edges over their rest lengths."""
    if not truth.has_gown:
        return np.full(len(truth.t), np.nan), np.full(len(truth.t), np.nan)
    moved = motion(truth.t, truth.vertices, truth.faces, truth.rest_vertices, truth.arms, truth.arm_radii)
    return moved.stretch_p99, moved.stretch_max


def _upper_arm(truth: Truth) -> np.ndarray:
    """(T, 2) way of each armhole up its upper arm."""
    parts = []
    for frames in _chunks(len(truth.t)):
        worn = sleeves_of(truth, frames)
        parts.append(np.stack([worn[side].armhole.upper_arm for side in SIDES], axis=1))
    return np.concatenate(parts)


def _distance(truth: Truth, hands: np.ndarray) -> np.ndarray:
    """(T, 2) from each hand to the skin of arms and torso front [m], 0 inside."""
    gaps = []
    for arm in range(2):
        for k in range(3):
            start = truth.arms[:, arm, k, None].astype(np.float64)
            axis = truth.arms[:, arm, k + 1, None] - start
            along = np.clip(((hands - start) * axis).sum(-1) / ((axis * axis).sum(-1) + 1e-12), 0.0, 1.0)
            gaps.append(np.linalg.norm(hands - start - along[..., None] * axis, axis=-1) - truth.arm_radii[arm, k])
    torso = [
        np.linalg.norm(hands[frames, :, None] - truth.torso_front[frames, None, :, :3], axis=-1).min(axis=2)
        for frames in _chunks(len(hands))
    ]
    return np.maximum(np.minimum(np.min(gaps, axis=0), np.concatenate(torso)), 0.0)


def _clearance(truth: Truth, rows: UnharmedRows) -> np.ndarray:
    """(T, 2) to head and neck, and elsewhere [m]."""
    near = clearance(truth, rows)
    return np.stack([near.least(near.head), near.least(~near.head)], axis=1)


def _speed(t: np.ndarray, hands: np.ndarray) -> np.ndarray:
    """(T, 2) of each hand, averaged over `SPEED_WINDOW` frames [m/s]."""
    window = min(SPEED_WINDOW, len(t) - 1)
    lasted = np.maximum(t[window:] - t[:-window], 1e-9)
    step = np.linalg.norm(hands[window:] - hands[:-window], axis=2) / lasted[:, None]
    return np.concatenate([np.repeat(step[:1], window, axis=0), step])
