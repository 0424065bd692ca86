"""From where to watch: the camera that sees most of the robot's hands, changed seldom and moved gently."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .camera import intrinsics_of, looking_at
from .diorama import ROOM_HIGH, ROOM_LOW
from .raster import Light, Triangles, rasterise

TRY_SIZE = (96, 72)  # of the pictures that candidates are judged by [px]
TRY_PERIOD = 1.0  # [s]
HOLD = 4.0  # a view is kept at least so long [s]
BETTER = 0.15  # a new view has to show so much more of the points, as a share
HIDDEN = 0.07  # a point this far behind what is seen there is hidden [m]
GLIDE = 0.12  # share of its way that a moving camera goes from picture to picture
APART = 0.75  # cosine between two views' directions, above which they show the same side
SAME_SIDE = 0.25  # what that costs, as a share of the points
WALL = 0.25  # a camera stays so far off the walls [m]
WIDE = tuple(
    np.array(eye)
    for eye in (
        (3.5, -2.5, 2.3),
        (-2.5, -2.5, 2.3),
        (-2.5, 3.0, 2.3),
        (3.4, 3.0, 2.3),
        (0.3, -2.7, 2.4),
        (0.3, 3.1, 2.3),
        (3.6, 0.2, 2.2),
        (-2.6, 0.2, 2.2),
    )
)
CLOSE = tuple(
    np.array((np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)))
    for e in (0.55, 1.05)
    for a in np.linspace(0.0, 2 * np.pi, 8, endpoint=False)
)  # directions from the hands
NEAREST, SPREAD = 1.1, 1.5  # distance from the hands [m], and in lengths of the way between them


@dataclass(frozen=True)
class Viewpoint:
    """Where a camera is and what it looks at, both (3,) [m]."""

    eye: np.ndarray
    target: np.ndarray

    @property
    def pose(self) -> np.ndarray:
        """Of the camera in the map (4, 4), optical frame."""
        return looking_at(self.eye, self.target)


def seen_share(triangles: Triangles, light: Light, view: Viewpoint, field_of_view: float, points: np.ndarray) -> float:
    """Share of `points` (n, 3) that a camera sees: in its picture, and with nothing before them."""
    intrinsics = intrinsics_of(TRY_SIZE, field_of_view)
    pose = view.pose
    depth = rasterise(triangles, light, intrinsics, pose, TRY_SIZE, closed=True).depth
    local = (points - pose[:3, 3]) @ pose[:3, :3]
    ahead = local[:, 2] > 0.05
    z = np.where(ahead, local[:, 2], 1.0)
    u = np.round(intrinsics[0] * local[:, 0] / z + intrinsics[2]).astype(int)
    v = np.round(intrinsics[1] * local[:, 1] / z + intrinsics[3]).astype(int)
    inside = ahead & (u >= 3) & (u < TRY_SIZE[0] - 3) & (v >= 3) & (v < TRY_SIZE[1] - 3)
    hit = depth[np.clip(v, 0, TRY_SIZE[1] - 1), np.clip(u, 0, TRY_SIZE[0] - 1)]
    return float(np.mean(inside & ((hit <= 0) | (hit > z - HIDDEN))))


class ViewChoice:
    """One camera that follows the hands.

    Args:
        field_of_view: horizontal [rad].
        close: from near the hands, else from the walls of the room.
    """

    def __init__(self, field_of_view: float, *, close: bool) -> None:
        self.field_of_view, self._close = field_of_view, close
        self._shown: Viewpoint | None = None
        self._chosen, self._since, self._tried = 0, -np.inf, -np.inf

    def at(
        self, time: float, triangles: Triangles, light: Light, hands: np.ndarray, other: Viewpoint | None = None
    ) -> Viewpoint:
        """The view at `time` [s].

        Args:
            time: world clock, which only grows [s].
            triangles: what there is to see.
            light: of the scene.
            hands: (n, 3) points of the robot's hands [m].
            other: a view that shows the other side already.
        """
        views = self._candidates(hands)
        if self._shown is None or time - self._tried >= TRY_PERIOD:
            self._tried = time
            scores = [self._score(view, triangles, light, hands, other) for view in views]
            best = int(np.argmax(scores))
            if self._shown is None or (time - self._since >= HOLD and scores[best] > scores[self._chosen] + BETTER):
                if best != self._chosen or self._shown is None:
                    self._shown, self._since = views[best], time  # a cut
                self._chosen = best
        wanted = views[self._chosen]
        assert self._shown is not None
        self._shown = Viewpoint(
            self._shown.eye + GLIDE * (wanted.eye - self._shown.eye),
            self._shown.target + GLIDE * (wanted.target - self._shown.target),
        )
        return self._shown

    def _candidates(self, hands: np.ndarray) -> Sequence[Viewpoint]:
        middle = hands.mean(axis=0)
        if not self._close:
            target = 0.5 * (middle + np.array((0.0, 0.0, 0.7)))
            return [Viewpoint(eye, target) for eye in WIDE]
        low, high = ROOM_LOW + WALL, ROOM_HIGH - WALL
        away = max(NEAREST, SPREAD * float(np.linalg.norm(np.ptp(hands, axis=0))))
        return [Viewpoint(np.clip(middle + away * direction, low, high), middle) for direction in CLOSE]

    def _score(
        self, view: Viewpoint, triangles: Triangles, light: Light, hands: np.ndarray, other: Viewpoint | None
    ) -> float:
        score = seen_share(triangles, light, view, self.field_of_view, hands)
        if other is not None and float(view.pose[:3, 2] @ other.pose[:3, 2]) > APART:
            score -= SAME_SIDE
        return score
