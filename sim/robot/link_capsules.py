"""The robot's links as capsules, one or two for each above the base.

The boxes of `shapes.py` become the capsules that fill them; its capsules stay what they are.
"""

from __future__ import annotations

import numpy as np

from ..mechanics.shape import LinkCapsule, Shape
from ..world import SIDES, Side
from . import model
from .shapes import collision_shapes

# capsule -> link of `shapes.py`; the base is left out: the map keeps it off the bed
_LIMB = {
    "shoulder": "upper_shoulder",
    "upper_arm": "upper_elbow",
    "elbow": "lower_elbow",
    "forearm": "upper_forearm",
    "wrist_1": "lower_forearm",
    "wrist_2": "wrist",
}


def link_capsules() -> tuple[LinkCapsule, ...]:
    """All capsules: of each arm from the shoulder to the fingers, then torso and head."""
    shapes = collision_shapes()
    capsules = []
    for side in SIDES:
        for name, link in _LIMB.items():
            capsules.append(of_capsule(f"{side}_{name}", f"{side}_{link}", shapes[f"{side}_{link}"][0]))
        capsules += palm_capsules(side)
        capsules += finger_capsules(side)
    capsules += upright_capsules("torso", "torso", shapes["torso"][0])
    return (*capsules, of_capsule("head", "head", shapes["head"][0]))


def of_capsule(name: str, link: str, shape: Shape) -> LinkCapsule:
    """The capsule that a link collides with."""
    radius, length = shape.size
    axis = shape.axis * length / 2
    return LinkCapsule(name=name, link=link, ends=np.array((shape.xyz - axis, shape.xyz + axis)), radius=radius)


def palm_capsules(side: Side) -> list[LinkCapsule]:
    """Two capsules along the closing direction, at either end of the palm's box."""
    across, closing, height = model.PALM_SIZE
    radius, half = across / 2, (closing - across) / 2
    return [
        LinkCapsule(
            name=f"{side}_palm_{n + 1}",
            link=f"{side}_gripper",
            ends=np.array(((0.0, -half, z), (0.0, half, z))),
            radius=float(radius),
        )
        for n, z in enumerate((radius, height - radius))
    ]


def finger_capsules(side: Side) -> list[LinkCapsule]:
    """One for each finger, as thick as it is: its pad faces the other one at y = 0."""
    _, thick, long = model.FINGER_SIZE
    radius = float(thick / 2)
    return [
        LinkCapsule(
            name=f"{side}_finger_{n + 1}",
            link=f"{side}_finger_{letter}_link",
            ends=np.array(((0.0, sign * radius, -long + radius), (0.0, sign * radius, -radius))),
            radius=radius,
        )
        for n, (letter, sign) in enumerate((("a", 1.0), ("b", -1.0)))
    ]


def upright_capsules(name: str, link: str, box: Shape) -> list[LinkCapsule]:
    """Two upright capsules beside each other, as deep as the box."""
    deep, wide, high = box.size
    radius, x, z = deep / 2, box.xyz[0], box.xyz[2]
    lift = high / 2 - radius
    return [
        LinkCapsule(
            name=f"{name}_{n + 1}",
            link=link,
            ends=np.array(((x, y, z - lift), (x, y, z + lift))),
            radius=radius,
        )
        for n, y in enumerate((radius - wide / 2, wide / 2 - radius))
    ]
