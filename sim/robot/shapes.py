"""Collision shapes of every link: a few boxes and capsules, shared by PyBullet and coal."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ..world import SIDES
from . import model


@dataclass(frozen=True, kw_only=True)
class Shape:
    """A primitive fixed to a link.

    Attributes:
        kind: `box` or `capsule` (along the local z axis).
        size: box edges (x, y, z) [m]; capsule radius and length between the centres of its caps [m].
        xyz: centre in the link frame [m].
        rpy: orientation in the link frame, URDF convention [rad].
        rgb: colour of the visual made from it, or None when it is a collision shape only.
    """

    kind: Literal["box", "capsule"]
    size: tuple[float, ...]
    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rgb: tuple[float, float, float] | None = None


DARK, STEEL, RED, BLACK = (0.20, 0.21, 0.23), (0.45, 0.46, 0.48), (0.55, 0.10, 0.10), (0.08, 0.08, 0.09)


def _base() -> tuple[Shape, ...]:
    length, width, top = model.BASE_SIZE
    deck = top - model.BASE_CLEARANCE
    column = model.TORSO_IN_BASE[2] - 0.06 - top  # Baxter's torso ends 6 cm below its frame
    cx, cy = model.COLUMN_SIZE
    return (
        Shape(kind="box", size=(length, width, deck), xyz=(0.0, 0.0, model.BASE_CLEARANCE + deck / 2), rgb=DARK),
        Shape(kind="box", size=(cx, cy, column), xyz=(model.TORSO_IN_BASE[0] - 0.05, 0.0, top + column / 2), rgb=STEEL),
    )


_ARM: dict[str, tuple[Shape, ...]] = {
    "upper_shoulder": (Shape(kind="capsule", size=(0.07, 0.16), xyz=(0.0, 0.0, 0.17)),),
    "upper_elbow": (Shape(kind="capsule", size=(0.075, 0.30), xyz=(0.0, 0.0, 0.09)),),
    "lower_elbow": (Shape(kind="capsule", size=(0.07, 0.08)),),
    "upper_forearm": (Shape(kind="capsule", size=(0.07, 0.26), xyz=(0.0, 0.0, 0.10)),),
    "lower_forearm": (Shape(kind="capsule", size=(0.06, 0.06)),),
    "wrist": (Shape(kind="capsule", size=(0.055, 0.08), xyz=(0.0, 0.0, 0.05)),),
    "gripper": (
        Shape(kind="box", size=tuple(model.PALM_SIZE), xyz=(0.0, 0.0, float(model.PALM_SIZE[2]) / 2), rgb=BLACK),
    ),
}


def _finger(sign: float) -> tuple[Shape, ...]:
    _, thick, long = model.FINGER_SIZE
    return (Shape(kind="box", size=tuple(model.FINGER_SIZE), xyz=(0.0, sign * thick / 2, -long / 2), rgb=STEEL),)


def collision_shapes() -> dict[str, tuple[Shape, ...]]:
    """Shapes of every link that has some, by link name."""
    shapes: dict[str, tuple[Shape, ...]] = {
        "base": _base(),
        "torso": (
            Shape(kind="box", size=(0.26, 0.36, 0.52), xyz=(-0.04, 0.0, 0.20)),
            Shape(kind="box", size=(0.22, 0.22, 0.18), xyz=(-0.02, 0.0, 0.55)),
        ),
        "head": (Shape(kind="capsule", size=(0.13, 0.10), xyz=(0.06, 0.0, 0.03)),),
    }
    for side in SIDES:
        shapes |= {f"{side}_{name}": value for name, value in _ARM.items()}
        shapes[f"{side}_finger_a_link"] = _finger(1.0)
        shapes[f"{side}_finger_b_link"] = _finger(-1.0)
    return shapes
