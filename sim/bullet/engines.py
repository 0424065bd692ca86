"""What moves the cloth of the room: PyBullet's soft bodies, or springs of our own.  Everything rigid is PyBullet's.

`spring-layers` is `spring` with a cloth that does not pass through itself, which PyBullet's does by default.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ..errors import CaretreeError
from ..scene.gown import GownMesh
from ..spring.room import SpringCloth, SpringRoom
from .cloth import Cloth, ClothBody
from .soft_world import SoftWorld

BULLET, SPRING, LAYERS = "bullet", "spring", "spring-layers"
Room = SoftWorld | SpringRoom


@dataclass(frozen=True, kw_only=True)
class ClothEngine:
    """One way of moving cloth.

    Attributes:
        name: how the command line calls it.
        room: makes an empty room with this time step [s].
        cloth: puts a cloth into such a room, starting at rest at vertices (V, 3) [m].
        soft_bodies: whether cloth is one of PyBullet's bodies, on which the effects of a model file act.
    """

    name: str
    room: Callable[[float], Any]
    cloth: Callable[[Any, GownMesh, np.ndarray], ClothBody]
    soft_bodies: bool


ENGINES = {
    engine.name: engine
    for engine in (
        ClothEngine(name=BULLET, room=SoftWorld, cloth=Cloth, soft_bodies=True),
        ClothEngine(name=SPRING, room=SpringRoom, cloth=SpringCloth, soft_bodies=False),
        ClothEngine(name=LAYERS, room=SpringRoom, cloth=partial(SpringCloth, meets_itself=True), soft_bodies=False),
    )
}


def engine_named(name: str) -> ClothEngine:
    """The engine called `name`.

    Raises:
        CaretreeError: there is none of that name.
    """
    if name not in ENGINES:
        raise CaretreeError(f"unknown engine {name!r}; there are {', '.join(ENGINES)}")
    return ENGINES[name]
