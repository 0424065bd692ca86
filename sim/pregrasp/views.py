"""Pictures around a gown that hangs from one hand, as the robot's camera delivers them, cropped to the gown."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .numbers import VIEWS, ViewNumbers

UP = np.array((0.0, 0.0, 1.0))


@dataclass(frozen=True, kw_only=True)
class Views:
    """The pictures; six of them in all that is trained on.

    Attributes:
        rgb: (6, H, W, 3) uint8.
        depth: (6, H, W) along the optical axis [m], 0 where the gown does not show.
        numbers: of the cameras.
        turns: (6,) of their directions about the vertical [rad]; None where each is a step after the one before.
    """

    rgb: np.ndarray
    depth: np.ndarray
    numbers: ViewNumbers = VIEWS
    turns: np.ndarray | None = None

    def turn(self, view: int) -> float:
        """Of a view's direction about the vertical [rad]."""
        return view * self.numbers.turn if self.turns is None else float(self.turns[view])

    def place(self, view: int, row: int, column: int) -> np.ndarray:
        """(3,) what a pixel shows, in the frame of the holding hand [m].

        Raises:
            ValueError: nothing of the gown.
        """
        depth = float(self.depth[view, row, column])
        if depth <= 0.0:
            raise ValueError(f"pixel ({row}, {column}) of view {view + 1} shows nothing of the gown")
        fx, fy, cx, cy = lens(self.numbers)
        ray = np.array(((column - cx) / fx, (row - cy) / fy, 1.0))
        pose = camera_pose(self.turn(view), self.numbers)
        return pose[:3, 3] + depth * (pose[:3, :3] @ ray)

    def places(self) -> tuple[np.ndarray, np.ndarray]:
        """All that shows: (n, 3) places in the frame of the holding hand [m], and (n, 3) view, row and column."""
        fx, fy, cx, cy = lens(self.numbers)
        found, spots = [np.zeros((0, 3))], [np.zeros((0, 3), int)]
        for view, depth in enumerate(self.depth):
            rows, columns = np.nonzero(depth)
            rays = np.column_stack([(columns - cx) / fx, (rows - cy) / fy, np.ones(len(rows))])
            pose = camera_pose(self.turn(view), self.numbers)
            found.append(pose[:3, 3] + (depth[rows, columns, None] * rays) @ pose[:3, :3].T)
            spots.append(np.column_stack([np.full(len(rows), view), rows, columns]))
        return np.concatenate(found), np.concatenate(spots)

    def pixel(self, view: int, place: np.ndarray) -> tuple[int, int]:
        """(row, column) in which a place (3,) of the hand's frame [m] lies; it may be outside of the picture."""
        fx, fy, cx, cy = lens(self.numbers)
        pose = camera_pose(self.turn(view), self.numbers)
        x, y, z = pose[:3, :3].T @ (place - pose[:3, 3])
        return round(fy * y / z + cy), round(fx * x / z + cx)


def level(turn: float) -> np.ndarray:
    """(3,) level unit vector, turned about the vertical from x [rad]."""
    return np.array((np.cos(turn), np.sin(turn), 0.0))


def lens(numbers: ViewNumbers = VIEWS) -> tuple[float, float, float, float]:
    """(fx, fy, cx, cy) [px]."""
    focal = numbers.distance / numbers.pixel
    return focal, focal, (numbers.width - 1) / 2, (numbers.height - 1) / 2


def camera_pose(turn: float, numbers: ViewNumbers = VIEWS) -> np.ndarray:
    """(4, 4) of a camera that looks in a direction [rad], optical frame, in the frame of the holding hand."""
    ahead, pose = level(turn), np.eye(4)
    pose[:3, :3] = np.column_stack([np.cross(ahead, UP), -UP, ahead])
    pose[:3, 3] = -numbers.distance * ahead + (numbers.above - numbers.height * numbers.pixel / 2) * UP
    return pose
