"""Reads arrays from truth.npz and rejects what could not be evaluated."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from ..errors import RecordError
from ..record.record import SPOOL_FOLDER, TRUTH_FILE
from ..record.spool import DAMAGED

Shape = tuple[str | int | None, ...]  # a letter stands for one length everywhere, None for any


def read_arrays(directory: Path, names: tuple[str, ...], optional: tuple[str, ...] = ()) -> dict[str, np.ndarray]:
    """The named arrays of `directory`/truth.npz, and those of `optional` that are there.

    Raises:
        RecordError: the file is missing, cut short or damaged, or lacks one of `names`.
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
            return {name: stored[name] for name in (*names, *(name for name in optional if name in stored.files))}
    except DAMAGED as error:
        raise RecordError(f"{path} is damaged and cannot be read: {error}") from error


def check_shapes(
    path: Path, arrays: Mapping[str, np.ndarray], shapes: Mapping[str, Shape], sizes: dict[str, int]
) -> None:
    """Check shapes, and that arrays hold numbers; where the name ends in `names` or `parts`, text.

    Args:
        path: of the file, for the message.
        arrays: by name.
        shapes: name -> shape asked for.
        sizes: letter -> length known so far; lengths met here are added.

    Raises:
        RecordError: a shape or a type is wrong.
    """
    for name, shape in shapes.items():
        given = arrays[name].shape
        fits = len(given) == len(shape) and all(
            want is None or got == (want if isinstance(want, int) else sizes.setdefault(want, got))
            for want, got in zip(shape, given, strict=True)
        )
        if not fits:
            asked = ", ".join("any" if want is None else str(sizes.get(str(want), want)) for want in shape)
            raise RecordError(f"{path}: {name} has shape {given}, but ({asked}) is asked for")
        kinds, kind = ("U", "text") if name.endswith(("_names", "_parts")) else ("biuf", "numbers")
        if arrays[name].dtype.kind not in kinds:
            raise RecordError(f"{path}: {name} holds {arrays[name].dtype}, but {kind} are asked for")


def check_indices(path: Path, arrays: Mapping[str, np.ndarray], names: Iterable[str], count: int) -> None:
    """Check that arrays hold vertex numbers below `count`.

    Raises:
        RecordError: one holds something else.
    """
    for name in names:
        index = arrays[name]
        if index.dtype.kind not in "iu" or (index.size and not 0 <= index.min() <= index.max() < count):
            raise RecordError(f"{path}: {name} holds something else than vertex numbers from 0 to {count - 1}")
