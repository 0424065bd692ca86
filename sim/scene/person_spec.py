"""Who lies on the bed: size, arm pose and joint stiffness, and the shape of the trunk."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..errors import CaretreeError
from ..world import Side

ARM_AXES = ("abduction", "elevation", "rotation", "flexion")


@dataclass(frozen=True, kw_only=True)
class PersonSpec:
    """Body size, arm pose and joint stiffness.  All lengths [m], angles [rad].

    Attributes:
        name: how the command line calls it.
        scale: body size relative to 174 cm.
        mass: [kg].
        radii: upper arm, forearm, hand.
        lengths: upper arm, forearm, hand.
        pose: side -> (abduction, elevation, rotation, flexion) at the start.
        dry_friction: (shoulder, elbow) torque that a joint resists with before it moves [N m].
        viscous: torque per joint speed [N m s/rad].
    """

    name: str = "average"
    scale: float = 1.0
    mass: float = 18.0
    radii: tuple[float, float, float] = (0.036, 0.033, 0.027)
    lengths: tuple[float, float, float] = (0.28, 0.25, 0.17)
    pose: dict[str, tuple[float, float, float, float]] = field(
        default_factory=lambda: {"left": (0.75, -0.12, -1.3, 0.5), "right": (0.75, -0.12, -1.3, 0.5)}
    )
    dry_friction: tuple[float, float] = (2.4, 1.2)
    viscous: float = 4.0

    def __post_init__(self) -> None:
        """Reject bodies outside the range the scene was built for.

        Raises:
            CaretreeError: a size, mass or friction out of range.
        """
        if not 0.85 <= self.scale <= 1.15:
            raise CaretreeError(f"person '{self.name}': scale {self.scale} is outside 0.85 to 1.15")
        if min(*self.radii, *self.lengths, self.mass, *self.dry_friction, self.viscous) <= 0:
            raise CaretreeError(f"person '{self.name}': sizes, mass and friction must be positive")


PERSONS: dict[str, PersonSpec] = {
    spec.name: spec
    for spec in (
        PersonSpec(),
        PersonSpec(name="small", scale=0.93, mass=15.5, dry_friction=(2.0, 1.0), viscous=3.0),
        PersonSpec(name="stiff", scale=1.03, mass=19.5, dry_friction=(2.8, 1.5), viscous=5.0),
    )
}


def shoulder_in_map(spec: PersonSpec, side: Side, bed_top: float, bed_xy: tuple[float, float]) -> np.ndarray:
    """Centre of a shoulder joint (3,) [m]; the person's left is at smaller x."""
    sign = -1.0 if side == "left" else 1.0
    return np.array([bed_xy[0] + sign * 0.20 * spec.scale, bed_xy[1] - 0.55, bed_top + 0.10])


def trunk_capsules(
    spec: PersonSpec, bed_top: float, bed_xy: tuple[float, float]
) -> list[tuple[np.ndarray, np.ndarray, float]]:
    """Chest and belly, legs, neck and head as (end, end, radius) in the map frame [m]."""
    s, (x, y), z = spec.scale, bed_xy, bed_top
    out = []
    for sign in (-1, 1):
        out.append(((x + sign * 0.09 * s, y - 0.50, z + 0.11 * s), (x + sign * 0.09 * s, y, z + 0.11 * s), 0.11 * s))
        out.append(
            (
                (x + sign * 0.10 * s, y + 0.02, z + 0.08 * s),
                (x + sign * 0.12 * s, y + 0.80 * s, z + 0.06 * s),
                0.075 * s,
            )
        )
    out.append(((x, y - 0.55 - 0.08 * s, z + 0.11 * s), (x, y - 0.55 - 0.22 * s, z + 0.12 * s), 0.09 * s))
    return [(np.array(a), np.array(b), radius) for a, b, radius in out]
