"""Between the pixels of a picture and points of the map frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame


@dataclass(frozen=True, kw_only=True)
class ProjectionTuning(Quantities):
    """Numbers of the projection."""

    min_depth: float = quantity(
        0.05, "m", "of a point before the camera that can be in view", "choice: what is nearer is no part of a scene"
    )
    paper_focal_length: float = quantity(
        466.0,
        "px",
        "of the pictures in which the paper states its distances",
        "paper: 640 wide, field of view 69 degrees",
    )


DEFAULT = ProjectionTuning()


class Camera(Protocol):
    """What a projection needs to know of a picture: `Frame` and `SkinView` have it."""

    @property
    def intrinsics(self) -> tuple[float, float, float, float]:
        """(fx, fy, cx, cy) [px]."""
        ...

    @property
    def pose_camera_in_map(self) -> np.ndarray:
        """(4, 4), optical frame: x right, y down, z forward."""
        ...


class Pixels(NamedTuple):
    """The pixels at which points of the map frame are seen.

    Attributes:
        rows: (n,) int, 0 for points out of view.
        columns: (n,) int, 0 for points out of view.
        depth: (n,) of the points along the camera's axis [m]; below zero behind the camera.
        inside: (n,) bool, whether the point is in view.
    """

    rows: np.ndarray
    columns: np.ndarray
    depth: np.ndarray
    inside: np.ndarray


def project(camera: Camera, points: np.ndarray) -> np.ndarray:
    """Pixel coordinates and depth of points.

    Args:
        camera: the picture's.
        points: (n, 3) or (3,) in the map frame [m].

    Returns:
        (n, 3) = (u, v, z) [px, px, m]; z <= 0 lies behind the camera.
    """
    fx, fy, cx, cy = camera.intrinsics
    pose = camera.pose_camera_in_map
    local = (np.atleast_2d(points) - pose[:3, 3]) @ pose[:3, :3]
    z = local[:, 2]
    safe = np.where(np.abs(z) < 1e-6, 1e-6, z)
    return np.column_stack([fx * local[:, 0] / safe + cx, fy * local[:, 1] / safe + cy, z])


def pixels_of(frame: Frame, points: np.ndarray, tuning: ProjectionTuning = DEFAULT) -> Pixels:
    """The nearest pixels to points (n, 3) in the map frame [m], with a mark for those that are out of view."""
    u, v, depth = project(frame, points).T
    height, width = frame.depth.shape
    inside = (depth > tuning.min_depth) & (u >= 0) & (u < width - 1) & (v >= 0) & (v < height - 1)
    rows, columns = (np.where(inside, np.round(x), 0).astype(int) for x in (v, u))
    return Pixels(rows, columns, depth, inside)


def points_in_map(frame: Frame) -> np.ndarray:
    """(H, W, 3) position of every pixel in the map frame [m]; NaN where there is no depth."""
    height, width = frame.depth.shape
    return points_at(frame, np.arange(height)[:, None], np.arange(width)[None, :])


def points_at(frame: Frame, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """(..., 3) position of the pixels at `rows` and `columns` (...,) in the map frame [m]; NaN without depth."""
    fx, fy, cx, cy = frame.intrinsics
    depth = frame.depth[rows, columns]
    z = np.where(depth > 0, depth, np.nan).astype(np.float64)
    pose = frame.pose_camera_in_map
    local = np.stack([(columns - cx) / fx * z, (rows - cy) / fy * z, z], axis=-1)
    return local @ pose[:3, :3].T + pose[:3, 3]


def pixel_scale(frame: Frame, tuning: ProjectionTuning = DEFAULT) -> float:
    """Pixels of this picture per pixel of the pictures in which the paper states its distances."""
    return frame.intrinsics[0] / tuning.paper_focal_length
