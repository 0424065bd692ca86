"""What stands still in the room and carries cloth and arms: the bed and the floor."""

from __future__ import annotations

from typing import Any

from ..scene.scene import BED_HALF, BED_THICKNESS, BED_TOP

_FLOOR = (4.0, 4.0, 0.05)  # half extents [m]
_BED_FRICTION, _FLOOR_FRICTION = 1.0, 0.5


def add_furniture(client: Any, bed_xy: tuple[float, float], plain: bool = True) -> None:
    """Put bed and floor into the room.

    Args:
        client: BulletClient of the room.
        bed_xy: middle of the bed in the map frame [m].
        plain: as rigid bodies without links, which soft bodies meet at half the cost, but whose shapes cannot be read.
    """
    bed = (*BED_HALF, BED_THICKNESS / 2)
    for half, middle, friction in (
        (bed, (*bed_xy, BED_TOP - bed[2]), _BED_FRICTION),
        (_FLOOR, (0.0, 0.0, -_FLOOR[2]), _FLOOR_FRICTION),
    ):
        shape = client.createCollisionShape(client.GEOM_BOX, halfExtents=half)
        body = client.createMultiBody(0, shape, useMaximalCoordinates=int(plain), basePosition=middle)
        client.changeDynamics(body, -1, lateralFriction=friction)
