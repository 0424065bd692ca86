"""Frames of a run on disk from the moment they happen, so that a crash or a full disk loses nothing earlier.

A spool is a folder with `static.npz` (what stays the same) and `frames.bin` (fixed-size rows).  A row cut
short by a crash is ignored.  `write_npz` turns a spool into truth.npz a few frames at a time.
"""

from __future__ import annotations

import errno
import json
import zipfile
import zlib
from pathlib import Path

import numpy as np

from ..errors import RecordError
from .truth import TruthFrame, TruthStatic, frame_type

# What numpy raises on an archive that is cut short, damaged or none at all.
DAMAGED = (OSError, ValueError, EOFError, AttributeError, NotImplementedError, zipfile.BadZipFile, zlib.error)
CHUNK = 256  # frames held in memory at once while writing truth.npz


def disk_error(error: OSError, doing: str) -> RecordError:
    """One sentence for an operating system error met while `doing` something."""
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return RecordError(f"the disk is full: stopped while {doing}; what was recorded before is kept")
    return RecordError(f"{doing} failed: {error.strerror or error}")


class Spool:
    """Appends frames to a folder.

    Args:
        folder: created; must not hold a spool yet.
        static: what stays the same for the whole run.

    Raises:
        RecordError: the folder cannot be written.
    """

    def __init__(self, folder: Path, static: TruthStatic) -> None:
        self.folder = folder
        self.static = static
        self.frames = 0
        self._row_type: np.dtype | None = None
        try:
            folder.mkdir(parents=True)
            # unbuffered: after a kill every frame handed over is in the file
            self._file = (folder / "frames.bin").open("wb", buffering=0)
        except OSError as error:
            raise disk_error(error, f"opening the record in {folder}") from error

    def append(self, frame: TruthFrame) -> None:
        """Write one frame.

        Raises:
            RecordError: a shape is wrong or differs from the first frame's, or the disk is full.
        """
        row_type = frame.row_type(self.static)
        points = len(frame.torso_front)
        if self._row_type is not None and row_type != self._row_type:
            first = self._row_type["torso_front"].shape[0]
            raise RecordError(f"torso_front has {points} points, but the first frame has {first}")
        row = np.zeros((), dtype=row_type)
        for name in row_type.names or ():
            row[name] = frame.value(name)
        rest = memoryview(row.tobytes())
        try:
            if self._row_type is None:
                shapes = {name: np.shape(state) for name, state in frame.objects.items()}
                np.savez(  # pyright: ignore[reportArgumentType] the stub knows no ** of arrays
                    self.folder / "static.npz",
                    torso_points=np.int64(points),
                    object_shapes=np.array(json.dumps(shapes)),
                    **self.static.arrays(),  # pyright: ignore[reportArgumentType]
                )
                self._row_type = row_type
            while rest:
                rest = rest[self._file.write(rest) :]
        except OSError as error:
            raise disk_error(error, f"recording frame {self.frames} in {self.folder}") from error
        self.frames += 1

    def close(self) -> None:
        """Close the file; may be called twice."""
        self._file.close()


def open_spool(folder: Path) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """The static arrays and a memory map (T,) of the frames of a spool, finished or not.

    Raises:
        RecordError: there is no readable spool with at least one whole frame.
    """
    try:
        with (folder / "static.npz").open("rb") as file, np.load(file, allow_pickle=False) as stored:
            static = {name: stored[name] for name in stored.files}
        row_type = frame_type(
            vertices=len(static["rest_vertices"]),
            torso_points=int(static.pop("torso_points")),
            parts=len(static["person_parts"]),
            links=len(static["robot_capsule_names"]),
            objects=json.loads(str(static.pop("object_shapes", "{}"))),
        )
        rows = (folder / "frames.bin").stat().st_size // row_type.itemsize
        if rows == 0:
            raise RecordError(f"{folder} holds no whole frame")
        return static, np.memmap(folder / "frames.bin", dtype=row_type, mode="r", shape=(rows,))
    except (OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
        raise RecordError(f"{folder} holds no readable frame") from error


def write_npz(folder: Path, path: Path) -> None:
    """Turn the spool in `folder` into the compressed archive `path`, `CHUNK` frames at a time.

    Written beside `path` first and renamed when whole: a full disk leaves the spool and no half archive.

    Raises:
        RecordError: the spool is unreadable or the disk is full.
    """
    static, frames = open_spool(folder)
    part = path.with_name(path.name + ".part")
    try:
        with zipfile.ZipFile(part, "w", compression=zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
            for name, array in static.items():
                with archive.open(f"{name}.npy", "w") as member:
                    np.lib.format.write_array(member, array, allow_pickle=False)
            for name in frames.dtype.names or ():
                field = frames[name]
                header = {"descr": field.dtype.str, "fortran_order": False, "shape": field.shape}
                with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                    np.lib.format.write_array_header_2_0(member, header)  # pyright: ignore[reportArgumentType] any file
                    for start in range(0, len(field), CHUNK):
                        member.write(field[start : start + CHUNK].tobytes())
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise disk_error(error, f"writing {path}") from error
