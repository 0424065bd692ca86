"""The room of a finished run, from its record: what `Diorama` shows of any frame of truth.npz."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..errors import CaretreeError
from ..scene.scene import RAIL_HEIGHT, Scene, draw_scene
from ..world_kind import EASY, WorldKind
from .appearance import gown_colours
from .camera import Renderer
from .diorama import Diorama, Furniture
from .looks import LOOKS, TAPED, draw_look

NEEDED = ("t", "vertices", "arms", "faces", "arm_radii")  # of truth.npz
OPTIONAL = ("robot_capsules", "robot_capsule_names", "person_capsules", "person_capsule_names", "bed_top")
CLOTH, TAPE = (140.0, 170.0, 205.0), (215.0, 220.0, 228.0)  # of a gown whose scene is not known


class RecordedRoom:
    """Shows one frame after the other.

    Args:
        run: run.json.
        arrays: of truth.npz, `NEEDED` and as many of `OPTIONAL` as there are.

    Attributes:
        t: (T,) world clock of the frames [s].
        diorama: that is moved from frame to frame.
    """

    def __init__(self, run: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> None:
        self.t = np.asarray(arrays["t"], float)
        self._vertices, self._arms = arrays["vertices"], arrays["arms"]
        self._capsules = arrays.get("robot_capsules")
        self._names = [str(name) for name in arrays.get("robot_capsule_names", ())]
        scene = _scene(run)
        trunk = {
            str(name): (np.array(row[:3], float), np.array(row[3:6], float), float(row[6]))
            for name, row in zip(
                arrays.get("person_capsule_names", ()), arrays.get("person_capsules", ()), strict=False
            )
            if np.ndim(row) == 1
        }
        lengths = np.linalg.norm(np.diff(self._arms[0], axis=1), axis=2)
        furniture = Furniture(
            bed_xy=scene.bed_xy if scene else (0.0, 0.0),
            bed_top=float(arrays.get("bed_top", 0.6)),
            rail=(*scene.rail_xy, RAIL_HEIGHT) if scene else None,
        )
        look = draw_look(_look(run), np.random.default_rng([abs(int(run.get("seed") or 0)), 1]))
        self.diorama = Diorama(look, furniture, trunk, arrays["arm_radii"], lengths)
        faces = np.asarray(arrays["faces"])
        if scene is not None and np.array_equal(scene.mesh.faces, faces):
            front, back, uv, printed = gown_colours(scene.mesh, look)
        else:
            front, back = (np.tile(colour, (len(faces), 1)) for colour in (CLOTH, TAPE))
            uv, printed = None, None
        self.diorama.renderer.set_cloth(self._vertices[0], faces, front, back, uv, printed)
        if self._capsules is not None:
            self.diorama.add_capsules(self._names, self._capsules[0])

    def at(self, index: int) -> Renderer:
        """The room in frame `index`, ready to draw."""
        self.diorama.renderer.move_cloth(self._vertices[index])
        self.diorama.move_arms(self._arms[index])
        if self._capsules is not None:
            self.diorama.move_capsules(self._names, self._capsules[index])
        return self.diorama.renderer


def _look(run: Mapping[str, Any]) -> str:
    parameters = run.get("parameters")
    look = parameters.get("look") if isinstance(parameters, Mapping) else None
    return str(look) if look in LOOKS else TAPED


def _scene(run: Mapping[str, Any]) -> Scene | None:
    """The scene that the run drew; None where it can no longer be drawn."""
    parameters = run.get("parameters")
    given = parameters if isinstance(parameters, Mapping) else {}
    try:
        kind = WorldKind.named(str(given.get("world_kind") or EASY))
        return draw_scene(int(run.get("seed") or 0), given.get("gown"), given.get("person"), kind)
    except (CaretreeError, TypeError, ValueError):
        return None
