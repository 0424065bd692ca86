"""What of truth.npz decides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import RecordError
from ..record.record import TRUTH_FILE
from ..record.truth import LOOPS
from .arrays_file import Shape, check_indices, check_shapes, read_arrays
from .unharmed_rows import ROWS, UnharmedRows, read_unharmed_rows

# T frames, V vertices
SHAPES: dict[str, Shape] = {
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
INDICES = ("faces", *(f"loop_{name}" for name in LOOPS))


@dataclass(frozen=True, kw_only=True)
class Truth:
    """The arrays of truth.npz that decide, as DESIGN.md names and shapes them; see `TruthFrame`.

    loops: name in `LOOPS` -> (n,) int.
    unharmed: what tells whether the person is unharmed; None where the record lacks all or some of it.
    lacks: names of the rows "unharmed" that are missing where others are there.
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
    unharmed: UnharmedRows | None = None
    lacks: tuple[str, ...] = ()

    @property
    def has_gown(self) -> bool:
        """Whether there is one."""
        return bool(len(self.rest_vertices) and len(self.faces))


def read_truth(directory: Path, *, gown: bool = True) -> Truth:
    """What decides, checked for shape, type and range of the vertex numbers.

    Args:
        directory: of the record.
        gown: there has to be one; a task may have taken it out of the room.

    Raises:
        RecordError: one of these is wrong, or there are fewer than two frames.
    """
    path = directory / TRUTH_FILE
    arrays = read_arrays(directory, tuple(SHAPES), optional=ROWS)
    sizes: dict[str, int] = {}
    check_shapes(path, arrays, SHAPES, sizes)
    check_indices(path, arrays, INDICES, sizes["V"])
    if sizes["T"] < 2:
        raise RecordError(f"{path} holds {sizes['T']} frames, but at least 2 are asked for")
    if gown and not (sizes["V"] and len(arrays["faces"])):
        raise RecordError(f"{path} holds a garment without vertices or faces")
    rows = {name: arrays.pop(name) for name in ROWS if name in arrays}
    loops = {name: arrays.pop(f"loop_{name}") for name in LOOPS}
    lacks = tuple(name for name in ROWS if name not in rows) if rows else ()
    unharmed = read_unharmed_rows(directory, rows, sizes) if rows and not lacks else None
    return Truth(loops=loops, unharmed=unharmed, lacks=lacks, **arrays)
