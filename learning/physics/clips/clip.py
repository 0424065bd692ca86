"""A depth clip of a falling gown: what the camera saw, and from where."""

from __future__ import annotations

import os
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....sim.errors import CaretreeError
from ..engine.fall import FRAMES, RATE

SIZE = 64  # height and width [px]
RIGID = 1e-3  # by which a rotation's products may be off
UNIT = 1e-4  # of stored depth [m]; 0 is "not gown"
_FIELDS = ("depth", "rate", "intrinsics", "pose_camera_in_map")
_DAMAGED = (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile, zlib.error)


@dataclass(frozen=True, kw_only=True)
class Clip:
    """15 depth frames at 30 Hz from the instant one of the two held vertices is let go.

    Attributes:
        depth: (15, 64, 64) float32 along the optical axis [m], NaN where there is no gown.
        rate: frames a second [Hz].
        intrinsics: (fx, fy, cx, cy) [px].
        pose_camera_in_map: (4, 4), optical frame; the map's origin is midway between the held vertices, z up.
    """

    depth: np.ndarray
    rate: float
    intrinsics: tuple[float, float, float, float]
    pose_camera_in_map: np.ndarray

    def __post_init__(self) -> None:
        """Reject what no method could use.

        Raises:
            CaretreeError: wrong shape, too few frames, wrong rate, all masked, a depth that is none, a bad camera.
        """
        shape = np.shape(self.depth)
        if len(shape) != 3 or shape[1:] != (SIZE, SIZE):
            raise CaretreeError(
                f"the clip has shape {'x'.join(map(str, shape)) or 'of a single number'}, "
                f"it must be {FRAMES}x{SIZE}x{SIZE} (frames, height, width)"
            )
        if shape[0] != FRAMES:
            raise CaretreeError(f"the clip has {shape[0]} frames, it must have {FRAMES}")
        if not np.isfinite(self.rate) or abs(self.rate - RATE) > 0.5:
            raise CaretreeError(f"the clip's rate is {self.rate:g} Hz, it must be {RATE:g} Hz")
        seen = np.isfinite(self.depth)
        if not seen.any():
            raise CaretreeError("every pixel of the clip is masked: no gown is seen")
        empty = np.flatnonzero(~seen.any(axis=(1, 2)))
        if len(empty):
            raise CaretreeError(f"frame {empty[0]} of the clip is all masked: the gown must be seen in every frame")
        if float(np.nanmin(self.depth)) <= 0.0 or float(np.nanmax(self.depth)) >= 65535 * UNIT:
            raise CaretreeError(
                f"the clip's depth runs from {np.nanmin(self.depth):.3g} to {np.nanmax(self.depth):.3g}"
                f" m, it must lie between 0 and {65535 * UNIT:.2f} m, and be NaN outside the gown"
            )
        if len(self.intrinsics) != 4 or not np.all(np.isfinite(self.intrinsics)) or min(self.intrinsics[:2]) <= 0:
            raise CaretreeError(
                "the clip's intrinsics must be four numbers, fx, fy, cx, cy [px], focal lengths above zero"
            )
        if np.shape(self.pose_camera_in_map) != (4, 4) or not np.all(np.isfinite(self.pose_camera_in_map)):
            raise CaretreeError("the clip's pose_camera_in_map must be a 4x4 matrix of finite numbers")
        rigid = np.asarray(self.pose_camera_in_map, float)
        turned = rigid[:3, :3] @ rigid[:3, :3].T  # the unit matrix, for a rotation
        if (
            np.abs(turned - np.eye(3)).max() > RIGID
            or np.abs(rigid[3] - (0, 0, 0, 1)).max() > RIGID
            or (np.linalg.det(rigid[:3, :3]) < 0)
        ):
            raise CaretreeError(
                "the clip's pose_camera_in_map must be a rotation and a translation, with 0, 0, 0, 1 in the last row"
            )

    def save(self, path: str | Path) -> Path:
        """Write one .npz, completely or not at all; returns its path."""
        path = Path(path)
        part = path.with_name(path.name + ".part")
        with part.open("wb") as file:
            np.savez_compressed(
                file,
                depth=np.asarray(self.depth, np.float32),
                rate=np.float64(self.rate),
                intrinsics=np.asarray(self.intrinsics, float),
                pose_camera_in_map=np.asarray(self.pose_camera_in_map, float),
            )
        os.replace(part, path)
        return path

    @staticmethod
    def load(path: str | Path) -> Clip:
        """Read what `save` wrote.

        Raises:
            CaretreeError: not a clip, or one that cannot be used; one sentence that names the file.
        """
        path = Path(path)
        if not path.is_file():
            raise CaretreeError(f"{path}: there is no such clip")
        try:
            with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
                missing = [name for name in _FIELDS if name not in file.files]
                values = {name: file[name] for name in file.files if name in _FIELDS}
        except (*_DAMAGED, AttributeError, TypeError) as error:
            raise CaretreeError(f"{path}: this is no clip, an .npz with {', '.join(_FIELDS)} is asked for") from error
        if missing:
            raise CaretreeError(f"{path}: the clip lacks {', '.join(missing)}; it needs {', '.join(_FIELDS)}")
        try:
            if any(np.iscomplexobj(value) for value in values.values()):
                raise TypeError("complex")
            return Clip(
                depth=values["depth"].astype(np.float32),
                rate=float(values["rate"]),
                intrinsics=tuple(float(v) for v in np.ravel(values["intrinsics"])),  # type: ignore[arg-type]
                pose_camera_in_map=values["pose_camera_in_map"].astype(float),
            )
        except CaretreeError as error:
            raise CaretreeError(f"{path}: {error}") from None
        except (TypeError, ValueError) as error:
            raise CaretreeError(f"{path}: depth, rate, intrinsics and pose_camera_in_map must be numbers") from error


def packed(depth: np.ndarray) -> np.ndarray:
    """Depth [m] with NaN -> uint16 in tenths of a millimetre with 0."""
    return np.rint(np.nan_to_num(depth, nan=0.0) / UNIT).astype(np.uint16)


def unpacked(raw: np.ndarray) -> np.ndarray:
    """What `packed` made, as float32 [m] with NaN where there is no gown."""
    depth = raw.astype(np.float32) * np.float32(UNIT)
    depth[raw == 0] = np.nan
    return depth
