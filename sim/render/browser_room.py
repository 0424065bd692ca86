"""Shows a room in a browser, through a scene of viser: bodies are sent once, then only what has moved."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from .camera import Renderer

STILL = 1e-4  # a pose that changes by less is not sent [m or 1]
EYE, TARGET = (2.9, -2.2, 2.1), (0.5, 0.1, 0.7)  # of the camera at first [m]
HIDDEN = ("ceiling",)  # people may want to look in from above


class BrowserRoom:
    """One room in one scene.

    Args:
        scene: viser's `server.scene`.
    """

    def __init__(self, scene: Any) -> None:
        self._scene = scene
        self._bodies: dict[str, Any] = {}
        self._poses: dict[str, np.ndarray] = {}
        self._shapes: dict[str, np.ndarray] = {}
        self._cloth: list[tuple[Any, np.ndarray]] = []
        scene.set_up_direction("+z")

    def show(self, time: float, room: Renderer) -> None:
        """Show the room as it is at `time` [s]."""
        for body in room.bodies():
            if body.name in HIDDEN:
                continue
            if body.name not in self._bodies:
                self._bodies[body.name] = self._scene.add_mesh_simple(
                    f"/room/{body.name}", body.vertices, body.faces, color=_rgb(body.colours[0]), side="double"
                )
                self._shapes[body.name] = body.vertices
            elif body.vertices is not self._shapes[body.name]:
                self._bodies[body.name].vertices = body.vertices.astype(np.float32)
                self._shapes[body.name] = body.vertices
            self._move(body.name, body.pose_in_map)
        self._drape(room.cloth)

    def _move(self, name: str, pose: np.ndarray) -> None:
        before = self._poses.get(name)
        if before is not None and np.abs(pose - before).max() < STILL:
            return
        self._poses[name] = pose.copy()
        x, y, z, w = Rotation.from_matrix(pose[:3, :3]).as_quat()
        self._bodies[name].wxyz = np.array((w, x, y, z))
        self._bodies[name].position = pose[:3, 3]

    def _drape(self, cloth: tuple[np.ndarray, ...] | None) -> None:
        """Show the cloth, one mesh for each colour of each side."""
        if cloth is None:
            for handle, _ in self._cloth:
                handle.remove()
            self._cloth = []
            return
        vertices = cloth[0].astype(np.float32)
        if not self._cloth:
            faces = cloth[1]
            for side, colours in (("front", cloth[2]), ("back", cloth[3])):
                for colour in np.unique(colours, axis=0):
                    chosen = faces[(colours == colour).all(axis=1)]
                    used, local = np.unique(chosen, return_inverse=True)
                    name = f"/cloth/{side}_{len(self._cloth)}"
                    mesh = self._scene.add_mesh_simple(
                        name, vertices[used], local.reshape(-1, 3), color=_rgb(colour), side=side
                    )
                    self._cloth.append((mesh, used))
        for handle, used in self._cloth:
            handle.vertices = vertices[used]


def _rgb(colour: np.ndarray) -> tuple[int, int, int]:
    red, green, blue = (int(np.clip(value, 0, 255)) for value in colour)
    return red, green, blue
