"""The simulated cameras: a scene of rigid bodies and one cloth, drawn by `raster`."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..errors import CaretreeError
from .camera_noise import add_sensor_noise
from .raster import DOTS, NEAR, Light, Picture, Print, Triangles, rasterise

CLOTH_ID = 0
FIELD_OF_VIEW = np.deg2rad(69.0)  # horizontal, of the hand cameras and the video
VIDEO_SIZE = (640, 480)  # (width, height) [px]
# Camera -> size [px] and horizontal field of view [rad].  The head's is wide: at 69 degrees, pitched 45 degrees down
# beside the bed, neither the near arm nor the near sleeve is in the picture (half of the seeds tried).
CAMERA_VIEWS: dict[str, tuple[tuple[int, int], float]] = {
    "head": ((400, 300), np.deg2rad(90.0)),
    "left_hand": ((320, 240), FIELD_OF_VIEW),
    "right_hand": ((320, 240), FIELD_OF_VIEW),
}
HEAD_SIZE = CAMERA_VIEWS["head"][0]


def intrinsics_of(size: tuple[int, int], field_of_view: float = FIELD_OF_VIEW) -> tuple[float, float, float, float]:
    """Pinhole parameters (fx, fy, cx, cy) [px] for square pixels and a horizontal `field_of_view` [rad]."""
    width, height = size
    focal = width / 2 / math.tan(field_of_view / 2)
    return float(focal), float(focal), (width - 1) / 2, (height - 1) / 2


def camera_intrinsics(camera: str) -> tuple[float, float, float, float]:
    """Pinhole parameters (fx, fy, cx, cy) [px] of one of the robot's cameras."""
    return intrinsics_of(*CAMERA_VIEWS[camera])


def looking_at(eye: np.ndarray, target: np.ndarray, up: tuple[float, float, float] = (0.0, 0.0, 1.0)) -> np.ndarray:
    """Camera pose (4, 4) in the map, optical frame, at `eye` looking at `target`, both (3,) [m]."""
    eye = np.asarray(eye, dtype=float)
    forward = np.asarray(target, dtype=float) - eye
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, up)
    if np.linalg.norm(right) < 1e-6:  # straight up or down: any horizontal right will do
        right = np.cross(forward, (0.0, 1.0, 0.0))
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack([right, np.cross(forward, right), forward])
    pose[:3, 3] = eye
    return pose


class Body(NamedTuple):
    """A rigid body: vertices (n, 3) in its own frame [m], faces and colours (m, 3), pose (4, 4)."""

    name: str
    vertices: np.ndarray
    faces: np.ndarray
    colours: np.ndarray
    pose_in_map: np.ndarray


class Renderer:
    """Holds what there is to see and draws it from anywhere.

    Bodies are added once; only poses and cloth vertices change between frames.  Ids follow the order of
    `add_rigid`, the cloth is `CLOTH_ID`.
    """

    def __init__(self, light: Light, on_cloth: Print = DOTS) -> None:
        self.light, self.on_cloth = light, on_cloth
        self.ids: dict[str, int] = {}
        self._local: dict[str, np.ndarray] = {}
        self._faces: dict[str, np.ndarray] = {}  # of each body alone
        self._poses: dict[str, np.ndarray] = {}
        self._slices: dict[str, slice] = {}
        self._closed: list[bool] = []  # of each body
        self._bounds: dict[str, np.ndarray] = {}  # (2, 3) of each body in its own frame [m]
        self._parts: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []  # vertices, faces, colours
        self._rigid: Triangles | None = None
        self._cloth: tuple[np.ndarray, ...] | None = None
        self._cloth_vertices = np.zeros((0, 3))

    def add_rigid(self, name: str, vertices: np.ndarray, faces: np.ndarray, colour: object) -> None:
        """Add a rigid body at the identity pose.

        Args:
            name: unique; `set_pose` refers to it.
            vertices: (n, 3) in the body's frame [m].
            faces: (m, 3) int.
            colour: (3,) for the whole body or (m, 3) per face, 0-255.

        Raises:
            CaretreeError: the name is taken.
        """
        if name in self._local:
            raise CaretreeError(f"the renderer already has a body '{name}'")
        vertices, faces = np.asarray(vertices, dtype=float), np.asarray(faces, dtype=np.int64)
        start = sum(len(v) for v, _, _ in self._parts)
        self._slices[name] = slice(start, start + len(vertices))
        self._local[name], self._faces[name], self._bounds[name] = vertices, faces, _bounds(vertices)
        self._closed.append(_is_closed(vertices, faces))
        self._poses[name] = np.eye(4)
        self.ids[name] = len(self.ids) + 1
        colours = np.broadcast_to(np.asarray(colour, dtype=float), (len(faces), 3))
        self._parts.append((vertices, faces + start, colours))
        self._rigid = None

    def set_pose(self, name: str, pose_in_map: np.ndarray) -> None:
        """Move a body; `pose_in_map` is (4, 4).

        Raises:
            CaretreeError: no such body.
        """
        if name not in self._local:
            raise CaretreeError(f"the renderer has no body '{name}', only {', '.join(self._local)}")
        self._poses[name] = pose_in_map
        if self._rigid is not None:
            self._place(name, self._rigid.vertices)

    def move_vertices(self, name: str, vertices: np.ndarray) -> None:
        """Change the shape of a body: as many vertices (n, 3) as it had, in its own frame [m].

        Raises:
            CaretreeError: no such body.
        """
        if name in self._local:
            self._local[name] = np.asarray(vertices, dtype=float)
            self._bounds[name] = _bounds(self._local[name])
        self.set_pose(name, self._poses.get(name, np.eye(4)))

    def remove_cloth(self) -> None:
        """Draw no cloth any more."""
        self._cloth = None

    def set_cloth(
        self,
        vertices: np.ndarray,
        faces: np.ndarray,
        front_colours: np.ndarray,
        back_colours: np.ndarray,
        uv: np.ndarray | None = None,
        printed: np.ndarray | None = None,
    ) -> None:
        """Define the cloth: vertices (V, 3) in the map, faces (F, 3), colours (F, 3) per side, print (see raster)."""
        n, m = len(vertices), len(faces)
        self._cloth = (
            np.asarray(faces, dtype=np.int64),
            np.asarray(front_colours, dtype=float),
            np.asarray(back_colours, dtype=float),
            np.zeros((n, 2)) if uv is None else np.asarray(uv),
            np.zeros(m, dtype=bool) if printed is None else np.asarray(printed),
        )
        self._cloth_vertices = np.asarray(vertices, dtype=float)

    def move_cloth(self, vertices: np.ndarray) -> None:
        """New positions (V, 3) of the cloth's vertices in the map [m]."""
        self._cloth_vertices = np.asarray(vertices, dtype=float)

    def bodies(self) -> Iterator[Body]:
        """Every rigid body as it is now, in the order in which they were added."""
        for (name, vertices), (_, _, colours) in zip(self._local.items(), self._parts, strict=True):
            yield Body(name, vertices, self._faces[name], colours, self._poses[name])

    @property
    def cloth(self) -> tuple[np.ndarray, ...] | None:
        """Vertices (V, 3), then what `set_cloth` was given beside them; None where there is no cloth."""
        return None if self._cloth is None else (self._cloth_vertices, *self._cloth)

    def triangles(self) -> Triangles:
        """The whole scene as it is now."""
        if self._rigid is None:
            self._rigid = self._assemble()
        rigid = self._rigid
        if self._cloth is None:
            return rigid
        faces, front, back, uv, printed = self._cloth
        start = len(rigid.vertices)
        return Triangles(
            vertices=np.vstack([rigid.vertices, self._cloth_vertices]),
            faces=np.vstack([rigid.faces, faces + start]),
            front=np.vstack([rigid.front, front]),
            back=np.vstack([rigid.back, back]),
            ids=np.concatenate([rigid.ids, np.full(len(faces), CLOTH_ID, dtype=np.int32)]),
            uv=np.vstack([rigid.uv, uv]),
            printed=np.concatenate([rigid.printed, printed]),
        )

    def render(
        self,
        pose_camera_in_map: np.ndarray,
        size: tuple[int, int] = VIDEO_SIZE,
        intrinsics: tuple[float, float, float, float] | None = None,
    ) -> Picture:
        """Draw a noiseless picture; default intrinsics are `intrinsics_of(size)`."""
        lens = intrinsics or intrinsics_of(size)
        corner = NEAR * math.hypot(1.0, lens[2] / lens[0], lens[3] / lens[1])  # of the near plane, from the camera [m]
        hidden = self._far_sides_hidden(pose_camera_in_map[:3, 3], corner)
        return rasterise(self.triangles(), self.light, lens, pose_camera_in_map, size, self.on_cloth, hidden)

    def _far_sides_hidden(self, eye: np.ndarray, cut: float) -> np.ndarray:
        """(bodies,) bool by id: closed ones farther from `eye` (3,) than `cut` [m], where no near plane opens them."""
        hidden = np.zeros(len(self.ids) + 1, dtype=bool)
        if self.ids:
            poses, bounds = np.array(list(self._poses.values())), np.array(list(self._bounds.values()))
            local = np.einsum("bji,bj->bi", poses[:, :3, :3], eye - poses[:, :3, 3])
            away = local - np.clip(local, bounds[:, 0], bounds[:, 1])
            hidden[1:] = self._closed & (np.einsum("bi,bi->b", away, away) > cut**2)
        return hidden

    def photograph(
        self, camera: str, pose_camera_in_map: np.ndarray, rng: np.random.Generator
    ) -> tuple[np.ndarray, np.ndarray]:
        """What one of the robot's cameras delivers: rgb (H, W, 3) uint8 and depth (H, W) float32 [m], with noise."""
        picture = self.render(pose_camera_in_map, CAMERA_VIEWS[camera][0], camera_intrinsics(camera))
        return add_sensor_noise(picture, rng)

    def _assemble(self) -> Triangles:
        if not self._parts:
            empty3, empty = np.zeros((0, 3)), np.zeros(0, dtype=np.int32)
            return Triangles(
                vertices=empty3,
                faces=empty3.astype(np.int64),
                front=empty3,
                back=empty3,
                ids=empty,
                uv=np.zeros((0, 2)),
                printed=empty.astype(bool),
            )
        vertices = np.vstack([v for v, _, _ in self._parts])
        faces = np.vstack([f for _, f, _ in self._parts])
        colours = np.vstack([c for _, _, c in self._parts])
        ids = np.concatenate([np.full(len(f), k + 1, dtype=np.int32) for k, (_, f, _) in enumerate(self._parts)])
        for name in self._local:
            self._place(name, vertices)
        return Triangles(
            vertices=vertices,
            faces=faces,
            front=colours,
            back=colours,
            ids=ids,
            uv=np.zeros((len(vertices), 2)),
            printed=np.zeros(len(faces), dtype=bool),
        )

    def _place(self, name: str, into: np.ndarray) -> None:
        pose = self._poses[name]
        into[self._slices[name]] = self._local[name] @ pose[:3, :3].T + pose[:3, 3]


def _bounds(vertices: np.ndarray) -> np.ndarray:
    """(2, 3) least and largest of vertices (n, 3) [m]."""
    return np.array((vertices.min(axis=0), vertices.max(axis=0)))


def _is_closed(vertices: np.ndarray, faces: np.ndarray) -> bool:
    """Whether each edge of faces (m, 3) that wind one way is one of another face the other way.

    Vertices (n, 3) at one place [m] are one: edges that are to be drawn sharp have their own on either side.
    """
    one = np.unique(vertices.round(6), axis=0, return_inverse=True)[1].ravel()[faces]
    edges = np.concatenate((one[:, :2], one[:, 1:], one[:, ::-2]))
    there, back = (np.sort(edges @ np.array(code)) for code in ((len(vertices), 1), (1, len(vertices))))
    return np.array_equal(there, back)
