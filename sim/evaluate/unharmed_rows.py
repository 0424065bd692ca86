"""What of truth.npz tells whether the person is unharmed: all of these rows, or none in records from before them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import RecordError
from ..record.record import TRUTH_FILE
from .arrays_file import Shape, check_indices, check_shapes, read_arrays

# T frames, r links of the robot, p parts of the person, k parts with a force
SHAPES: dict[str, Shape] = {
    "robot_capsules": ("T", "r", 7),
    "robot_capsule_names": ("r",),
    "holds_arm": ("T", 2),
    "person_capsules": ("p", 7),
    "person_capsule_names": ("p",),
    "bed_top": (),
    "face": (6,),
    "neckline": (None,),
}
FORCE: dict[str, Shape] = {"person_force": ("T", "k"), "person_parts": ("k",)}  # records without the rows have them too
ROWS = tuple(SHAPES)


@dataclass(frozen=True, kw_only=True)
class UnharmedRows:
    """The rows "unharmed" of truth.npz and the forces, as DESIGN.md names and shapes them; see `TruthStatic`.

    person_capsules: (T, p, 7) [m], also where the record holds them once for all frames.
    """

    robot_capsules: np.ndarray
    robot_capsule_names: tuple[str, ...]
    holds_arm: np.ndarray
    person_capsules: np.ndarray
    person_capsule_names: tuple[str, ...]
    bed_top: float
    face: np.ndarray
    neckline: np.ndarray
    person_force: np.ndarray
    person_parts: tuple[str, ...]


def read_unharmed_rows(directory: Path, rows: dict[str, np.ndarray], sizes: dict[str, int]) -> UnharmedRows:
    """The rows, checked for shape, type and range, with the forces read in addition.

    Args:
        directory: of the record.
        rows: the arrays named in `ROWS`.
        sizes: number of frames `T` and of vertices `V`.

    Raises:
        RecordError: a shape, a type or a vertex number is wrong, or the forces are missing.
    """
    path = directory / TRUTH_FILE
    arrays = rows | read_arrays(directory, tuple(FORCE))
    body = SHAPES["person_capsules"]
    if arrays["person_capsules"].ndim == 3:  # a person who moves
        body = ("T", *body)
    check_shapes(path, arrays, SHAPES | FORCE | {"person_capsules": body}, sizes)
    check_indices(path, arrays, ("neckline",), sizes["V"])
    if sizes["V"] and not len(arrays["neckline"]):  # a task may have taken the gown out of the room
        raise RecordError(f"{path}: neckline names no vertices")
    frames = (sizes["T"], sizes["p"], 7)
    return UnharmedRows(
        robot_capsules=arrays["robot_capsules"],
        robot_capsule_names=_names(arrays["robot_capsule_names"]),
        holds_arm=arrays["holds_arm"],
        person_capsules=np.broadcast_to(arrays["person_capsules"], frames),
        person_capsule_names=_names(arrays["person_capsule_names"]),
        bed_top=float(arrays["bed_top"]),
        face=arrays["face"].astype(np.float64),
        neckline=arrays["neckline"],
        person_force=arrays["person_force"],
        person_parts=_names(arrays["person_parts"]),
    )


def _names(array: np.ndarray) -> tuple[str, ...]:
    return tuple(str(name) for name in array)
