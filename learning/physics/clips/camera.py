"""The one fixed camera that watches falling gowns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....sim.render.camera import intrinsics_of, looking_at
from ....sim.render.raster import Light, Triangles, rasterise
from ....sim.scene.gown import GownMesh
from .clip import SIZE

YAW = np.deg2rad(30.0)  # from the gown's outward direction: sleeves and bulge show, and so does the swing
DISTANCE = 2.6  # [m]
EYE_HEIGHT = -0.5  # above the held vertices [m]
TARGET = (-0.1, 0.0, -0.85)  # middle of where base gowns swing to [m]
HALF = 0.95  # half of the picture's width at the target [m]


TURN = np.deg2rad(1.5)  # usual error of where a camera is said to look, about each axis [rad]
SHIFT = 0.03  # usual error of where it is said to stand, along each axis [m]
MISPLACED = np.array((TURN,) * 3 + (SHIFT,) * 3)


def misplacement(rng: np.random.Generator) -> np.ndarray:
    """(6,) normal errors of a camera's place, as `ClipCamera.moved` takes them."""
    return rng.normal(0.0, 1.0, 6) * MISPLACED


@dataclass(frozen=True, kw_only=True)
class ClipCamera:
    """Where the camera stands, in the map of the clip (origin midway between the held vertices, z up).

    Attributes:
        pose_camera_in_map: (4, 4), optical frame.
        intrinsics: (fx, fy, cx, cy) [px].
    """

    pose_camera_in_map: np.ndarray
    intrinsics: tuple[float, float, float, float]

    def moved(self, misplaced: np.ndarray) -> ClipCamera:
        """The camera misplaced by (6,): a rotation vector in its own frame [rad], then a shift in the map [m]."""
        axis = np.asarray(misplaced[:3], float)
        angle = float(np.linalg.norm(axis))
        x, y, z = axis / max(angle, 1e-12)
        cross = np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))
        pose = self.pose_camera_in_map.copy()
        pose[:3, :3] = pose[:3, :3] @ (np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)
        pose[:3, 3] += misplaced[3:]
        return ClipCamera(pose_camera_in_map=pose, intrinsics=self.intrinsics)

    def look(self, mesh: GownMesh, vertices: np.ndarray) -> np.ndarray:
        """(64, 64) float32 depth of a gown with these vertices (V, 3) [m], NaN where there is none."""
        faces, count = len(mesh.faces), len(vertices)
        scene = Triangles(
            vertices=vertices,
            faces=mesh.faces,
            front=np.zeros((faces, 3)),
            back=np.zeros((faces, 3)),
            ids=np.zeros(faces, np.int32),
            uv=np.zeros((count, 2)),
            printed=np.zeros(faces, bool),
        )
        light = Light(direction_in_map=np.array((0.0, 0.0, 1.0)))
        depth = rasterise(scene, light, self.intrinsics, self.pose_camera_in_map, (SIZE, SIZE)).depth
        depth[depth <= 0] = np.nan
        return depth


def standard_camera() -> ClipCamera:
    """The camera of every clip whose camera was not moved."""
    target = np.array(TARGET)
    eye = np.array((TARGET[0] + DISTANCE * np.sin(YAW), DISTANCE * np.cos(YAW), EYE_HEIGHT))
    return ClipCamera(
        pose_camera_in_map=looking_at(eye, target),
        intrinsics=intrinsics_of((SIZE, SIZE), 2 * float(np.arctan(HALF / DISTANCE))),
    )
