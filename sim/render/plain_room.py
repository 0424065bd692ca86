"""A room of boxes for worlds without a picture of themselves, such as hardware: what was mapped, and what is sensed."""

from __future__ import annotations

import numpy as np

from ..world import SIDES, Observation, RoomMap
from .camera import Renderer
from .raster import Light
from .solids import box_mesh, join_meshes

COLOURS = {"left": (31, 111, 178), "right": (200, 100, 27)}  # as in the report
BED, FLOOR, BASE = (209, 207, 202), (184, 174, 143), (80, 80, 84)


class PlainRoom:
    """Bed, base and hands as boxes.

    Args:
        room: as mapped.
    """

    def __init__(self, room: RoomMap) -> None:
        self._renderer = Renderer(Light(direction_in_map=np.array((0.0, 0.0, 1.0))))
        low = np.array((*room.origin, -0.05))
        size = np.array(room.free.shape[::-1]) * room.resolution
        self._renderer.add_rigid("floor", *box_mesh(low, np.array((*(low[:2] + size), 0.0))), FLOOR)
        self._renderer.add_rigid("bed", *box_mesh(*room.bed), BED)
        mast = box_mesh(np.array((-0.15, -0.15, 0.3)), np.array((0.15, 0.15, 1.1)))
        deck = box_mesh(np.array((-0.45, -0.35, 0.0)), np.array((0.45, 0.35, 0.3)))
        self._renderer.add_rigid("base", *join_meshes([deck, mast]), BASE)
        for side in SIDES:
            palm = box_mesh(np.array((-0.03, -0.05, -0.16)), np.array((0.03, 0.05, -0.06)))
            fingers = [
                box_mesh(np.array((-0.01, y - 0.01, -0.06)), np.array((0.01, y + 0.01, 0.0))) for y in (-0.04, 0.04)
            ]
            self._renderer.add_rigid(f"{side}_hand", *join_meshes([palm, *fingers]), COLOURS[side])

    def at(self, seen: Observation) -> Renderer:
        """The room as sensed, ready to be shown."""
        x, y, yaw = seen.pose_base_in_map
        pose = np.eye(4)
        pose[:2, :2] = ((np.cos(yaw), -np.sin(yaw)), (np.sin(yaw), np.cos(yaw)))
        pose[:2, 3] = x, y
        self._renderer.set_pose("base", pose)
        for side, hand in zip(SIDES, seen.pose_hand_in_map, strict=True):
            self._renderer.set_pose(f"{side}_hand", hand)
        return self._renderer
