"""Reads truth.npz and rejects what could not be evaluated."""

from __future__ import annotations

import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import RecordError
from ..record.record import SPOOL_FOLDER, TRUTH_FILE
from ..record.truth import LOOPS

# T frames, V vertices; None is free
SHAPES: dict[str, tuple[str | int | None, ...]] = {
    "t": ("T",),
    "vertices": ("T", "V", 3),
    "faces": (None, 3),
    "rest_vertices": ("V", 3),
    **{f"loop_{name}": (None,) for name in LOOPS},
    "arms": ("T", 2, 4, 3),
    "arm_radii": (2, 3),
    "torso_front": ("T", None, 6),
    "gripper_closed": ("T", 2),
    "gripper_load": ("T", 2, 3),
}
DAMAGED = (OSError, ValueError, EOFError, AttributeError, NotImplementedError, zipfile.BadZipFile, zlib.error)
INDICES = ("faces", *(f"loop_{name}" for name in LOOPS))


@dataclass(frozen=True, kw_only=True)
class Truth:
    """The arrays of truth.npz that decide, as DESIGN.md names and shapes them; see `TruthFrame`.

    loops: name in `LOOPS` -> (n,) int.
    """

    t: np.ndarray
    vertices: np.ndarray
    faces: np.ndarray
    rest_vertices: np.ndarray
    loops: Mapping[str, np.ndarray]
    arms: np.ndarray
    arm_radii: np.ndarray
    torso_front: np.ndarray
    gripper_closed: np.ndarray
    gripper_load: np.ndarray


def read_arrays(directory: Path, names: tuple[str, ...]) -> dict[str, np.ndarray]:
    """The named arrays of `directory`/truth.npz.

    Raises:
        RecordError: the file is missing, cut short or damaged, or lacks an array.
    """
    path = directory / TRUTH_FILE
    if not path.exists():
        if (directory / SPOOL_FOLDER).exists():
            raise RecordError(f"{directory} was cut short: its frames are in {SPOOL_FOLDER}, not in {TRUTH_FILE}")
        raise RecordError(f"{directory} holds no {TRUTH_FILE}, so nothing is known of the gown")
    try:
        # opened here: numpy leaves its own file open when the archive is damaged
        with path.open("rb") as file, np.load(file, allow_pickle=False) as stored:
            missing = [name for name in names if name not in stored.files]
            if missing:
                raise RecordError(f"{path} lacks {', '.join(missing)}")
            return {name: stored[name] for name in names}
    except DAMAGED as error:
        raise RecordError(f"{path} is damaged and cannot be read: {error}") from error


def read_truth(directory: Path) -> Truth:
    """What decides, checked for shape, type and range of the vertex numbers.

    Raises:
        RecordError: one of these is wrong, or there are fewer than two frames.
    """
    arrays = read_arrays(directory, tuple(SHAPES))
    sizes: dict[str, int] = {}
    for name, shape in SHAPES.items():
        given = arrays[name].shape
        fits = len(given) == len(shape) and all(
            want is None or got == (want if isinstance(want, int) else sizes.setdefault(want, got))
            for want, got in zip(shape, given, strict=True)
        )
        if not fits:
            asked = ", ".join("any" if want is None else str(sizes.get(str(want), want)) for want in shape)
            raise RecordError(f"{directory / TRUTH_FILE}: {name} has shape {given}, but ({asked}) is asked for")
        if arrays[name].dtype.kind not in "biuf":
            raise RecordError(f"{directory / TRUTH_FILE}: {name} holds {arrays[name].dtype}, but numbers are asked for")
    for name in INDICES:
        index = arrays[name]
        if index.dtype.kind not in "iu" or (index.size and not 0 <= index.min() <= index.max() < sizes["V"]):
            raise RecordError(
                f"{directory / TRUTH_FILE}: {name} holds something else than vertex numbers from 0 to {sizes['V'] - 1}"
            )
    if sizes["T"] < 2:
        raise RecordError(f"{directory / TRUTH_FILE} holds {sizes['T']} frames, but at least 2 are asked for")
    if not sizes["V"] or not len(arrays["faces"]):
        raise RecordError(f"{directory / TRUTH_FILE} holds a garment without vertices or faces")
    loops = {name: arrays.pop(f"loop_{name}") for name in LOOPS}
    return Truth(loops=loops, **arrays)
