"""Collision shapes of every link: a few boxes and capsules, shared by PyBullet and coal."""

from __future__ import annotations

from ..mechanics.shape import Shape
from ..world import SIDES
from . import model

LIMBS = ("upper_elbow", "lower_elbow", "upper_forearm", "lower_forearm", "wrist", "gripper")
_DISTAL = ("upper_forearm", "lower_forearm", "wrist", "gripper")  # these can meet the robot's own body
_FIXED = ("torso", "base", "head")
DARK, STEEL, RED, BLACK = (0.20, 0.21, 0.23), (0.45, 0.46, 0.48), (0.55, 0.10, 0.10), (0.08, 0.08, 0.09)


def base_box() -> tuple[Shape, ...]:
    """The base without what stands on it."""
    length, width, top = model.BASE_SIZE
    deck = top - model.BASE_CLEARANCE
    return (Shape(kind="box", size=(length, width, deck), xyz=(0.0, 0.0, model.BASE_CLEARANCE + deck / 2), rgb=DARK),)


def _base() -> tuple[Shape, ...]:
    top = model.BASE_SIZE[2]
    column = model.TORSO_IN_BASE[2] - 0.06 - top  # Baxter's torso ends 6 cm below its frame
    cx, cy = model.COLUMN_SIZE
    return (
        *base_box(),
        Shape(kind="box", size=(cx, cy, column), xyz=(model.TORSO_IN_BASE[0] - 0.05, 0.0, top + column / 2), rgb=STEEL),
    )


_ARM: dict[str, tuple[Shape, ...]] = {
    "upper_shoulder": (Shape(kind="capsule", size=(0.07, 0.16), xyz=(0.0, 0.0, 0.17)),),
    "upper_elbow": (Shape(kind="capsule", size=(0.075, 0.30), xyz=(0.0, 0.0, 0.09)),),
    "lower_elbow": (Shape(kind="capsule", size=(0.07, 0.08)),),
    "upper_forearm": (Shape(kind="capsule", size=(0.07, 0.26), xyz=(0.0, 0.0, 0.10)),),
    "lower_forearm": (Shape(kind="capsule", size=(0.06, 0.06)),),
    "wrist": (Shape(kind="capsule", size=(0.055, 0.08), xyz=(0.0, 0.0, 0.05)),),
}


def palm_shapes() -> tuple[Shape, ...]:
    """The palm of a gripper."""
    size = model.PALM_SIZE
    return (Shape(kind="box", size=tuple(size), xyz=(0.0, 0.0, float(size[2]) / 2), rgb=BLACK),)


def finger_shapes(sign: float) -> tuple[Shape, ...]:
    """One finger, on the side of the closing direction that `sign` tells."""
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
        shapes[f"{side}_gripper"] = palm_shapes()
        shapes[f"{side}_finger_a_link"] = finger_shapes(1.0)
        shapes[f"{side}_finger_b_link"] = finger_shapes(-1.0)
    return shapes


def own_pairs() -> tuple[tuple[str, str], ...]:
    """Links that could touch each other."""
    pairs = [(f"left_{a}", f"right_{b}") for a in LIMBS for b in LIMBS]
    for side in SIDES:
        other = SIDES[1 - SIDES.index(side)]
        pairs += [(f"{side}_{a}", b) for a in _DISTAL for b in _FIXED]
        pairs += [(f"{side}_{a}", f"{other}_upper_shoulder") for a in _DISTAL]
        pairs += [
            (f"{side}_{a}", f"{side}_{b}") for a in ("wrist", "gripper") for b in ("upper_shoulder", "upper_elbow")
        ]
        pairs += [(f"{side}_lower_elbow", b) for b in ("torso", "head")]
    return tuple(pairs)
