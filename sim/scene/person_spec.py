"""Who lies on the bed: everything that is known about the body, its arms' joints and how it lies.

174 cm and 18 kg as the patient-care manikin of the paper.  Physics (`bullet/person.py`), pictures
(`bullet/backdrop.py`), forces (`bullet/person_force.py`) and the record derive what they need from here.

Joint zero: the arm points along the body towards the feet, palm to the thigh.  Angles of both sides have
the same meaning: `abduction` swings the arm away from the body in the plane of the bed, `elevation` lifts
it off the bed, `rotation` turns it about the upper arm, `flexion` bends the elbow (towards the front of
the body at rotation 0, towards the midline at rotation -90 degrees).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..errors import CaretreeError
from ..quantity import Quantities, quantity
from ..world import SIDES, Side

ARM_AXES = ("abduction", "elevation", "rotation", "flexion")
ARM_SEGMENTS = ("upper_arm", "forearm", "hand")
PERSON_PARTS = ("trunk", *(f"{side}_{segment}" for side in SIDES for segment in ARM_SEGMENTS), "legs", "head")
OUTWARD: dict[Side, float] = {"left": -1.0, "right": 1.0}  # the person's left is at smaller x
JOINT_LIMITS = {
    "abduction": (-0.2, 1.9),
    "elevation": (-0.35, 1.6),
    "rotation": (-1.8, 1.8),
    "flexion": (0.0, 2.4),
}  # [rad]
LYING_ELEVATION, LYING_ROTATION = -0.12, -1.3  # of an arm that rests on the bed [rad]

Capsule = tuple[np.ndarray, np.ndarray, float]


@dataclass(frozen=True, kw_only=True)
class BodyShape(Quantities):
    """A lying body of 174 cm: x from its midline, y from the middle of the bed, z over the mattress."""

    shoulder_x: float = quantity(0.20, "m", "of the shoulder joints", "choice: a manikin of 174 cm")
    shoulder_y: float = quantity(0.55, "m", "of the shoulder joints, towards the head", "choice: head on the pillow")
    shoulder_z: float = quantity(0.10, "m", "of the shoulder joints", "choice: a manikin of 174 cm")
    chest_x: float = quantity(0.09, "m", "of the two capsules from chest to belly", "choice: a manikin of 174 cm")
    chest_y: float = quantity(0.50, "m", "of the upper end of the chest, towards the head", "choice: below the neck")
    chest_radius: float = quantity(0.11, "m", "of the chest's capsules, which lie on the bed", "choice: as its width")
    hip_x: float = quantity(0.10, "m", "of the upper ends of the legs", "choice: a manikin of 174 cm")
    hip_y: float = quantity(0.02, "m", "of the upper ends of the legs, towards the feet", "choice: below the belly")
    hip_z: float = quantity(0.08, "m", "of the upper ends of the legs", "choice: a manikin of 174 cm")
    foot_x: float = quantity(0.12, "m", "of the lower ends of the legs", "choice: a manikin of 174 cm")
    foot_y: float = quantity(0.80, "m", "of the lower ends of the legs, towards the feet", "choice: fits the bed")
    foot_z: float = quantity(0.06, "m", "of the lower ends of the legs", "choice: a manikin of 174 cm")
    leg_radius: float = quantity(0.075, "m", "of the legs", "choice: a manikin of 174 cm")
    neck_y: float = quantity(0.08, "m", "of the neck, from the shoulders to the head", "choice: a manikin of 174 cm")
    neck_z: float = quantity(0.11, "m", "of the neck", "choice: a manikin of 174 cm")
    head_y: float = quantity(0.22, "m", "of the head, from the shoulders", "choice: a manikin of 174 cm")
    head_z: float = quantity(0.12, "m", "of the head", "choice: on a pillow")
    head_radius: float = quantity(0.09, "m", "of neck and head", "choice: a manikin of 174 cm")
    face_y: float = quantity(
        0.17, "m", "between mouth and nose, from the shoulders towards the head", "choice: 14 cm below the crown"
    )
    front_x: float = quantity(0.15, "m", "half the width of the front of the trunk", "choice: all but the rim")
    front_y: float = quantity(0.06, "m", "of the waist, towards the head", "choice: where chest and belly end")
    arm_mass_share: float = quantity(
        0.05, "1", "share of one arm in the body's mass", "paper: Winter, Biomechanics of Human Movement, table 4.1"
    )
    segment_mass_shares: tuple[float, float, float] = quantity(
        (0.54, 0.32, 0.14),
        "1",
        "shares of upper arm, forearm and hand in an arm's mass",
        "paper: Winter, Biomechanics of Human Movement, table 4.1",
    )
    skin_friction: float = quantity(
        0.5, "1", "of trunk and arms; Bullet multiplies it with the cloth's", "choice: not measured; 0.2 with a gown"
    )


SHAPE = BodyShape()


@dataclass(frozen=True, kw_only=True)
class StiffShoulder:
    """A shoulder that resists, and whose range ends early.

    Attributes:
        dry_friction: torque with which each of its axes resists before it moves [N m].
        elevation_end: off the bed, from which on it springs back [rad].
        abduction_end: from the body, from which on it springs back [rad].
        end_stiffness: of that spring [N m/rad].
    """

    dry_friction: float
    elevation_end: float
    abduction_end: float
    end_stiffness: float


@dataclass(frozen=True, kw_only=True)
class PersonSpec:
    """Body size, arm pose and joint stiffness.  All lengths [m], angles [rad].

    Attributes:
        name: how the command line calls it.
        scale: body size relative to 174 cm.
        mass: [kg].
        radii: of the arm's segments before scaling.
        lengths: of the arm's segments before scaling.
        pose: side -> angles in the order of `ARM_AXES` at the start.
        dry_friction: (shoulder, elbow) torque that a joint resists with before it moves [N m].
        viscous: torque per joint speed [N m s/rad].
        stiff: side -> a shoulder that is not like the others.
        skin_friction: of trunk and arms; times the cloth's, it is the coefficient between both.
        stirring: torque with which the person can swing the arms, if more than three times the friction [N m].
        arm_mass_added: of each arm, in the shares of its segments [kg].
        shoulder_spring: torque with which abduction and elevation are drawn back to the start, per angle [N m/rad].
        falls: whether nothing but contact carries the arms: they are let come to rest before a run, and their upper
            parts may lie against the trunk, which is as wide as the shoulders.
    """

    name: str = "average"
    scale: float = 1.0
    mass: float = 18.0
    radii: tuple[float, float, float] = (0.036, 0.033, 0.027)
    lengths: tuple[float, float, float] = (0.28, 0.25, 0.17)
    pose: dict[str, tuple[float, float, float, float]] = field(
        default_factory=lambda: {side: (0.75, LYING_ELEVATION, LYING_ROTATION, 0.5) for side in SIDES}
    )
    dry_friction: tuple[float, float] = (2.4, 1.2)
    viscous: float = 4.0
    stiff: dict[str, StiffShoulder] = field(default_factory=dict)
    skin_friction: float = SHAPE.skin_friction
    stirring: float = 0.0
    arm_mass_added: float = 0.0
    shoulder_spring: float = 0.0
    falls: bool = False

    def __post_init__(self) -> None:
        """Reject bodies outside the range the scene was built for.

        Raises:
            CaretreeError: a size, mass or friction out of range.
        """
        if not 0.85 <= self.scale <= 1.15:
            raise CaretreeError(f"person '{self.name}': scale {self.scale} is outside 0.85 to 1.15")
        if min(*self.radii, *self.lengths, self.mass, *self.dry_friction, self.viscous, self.skin_friction) <= 0:
            raise CaretreeError(f"person '{self.name}': sizes, mass and friction must be positive")
        if self.arm_masses.min() <= 0 or self.shoulder_spring < 0:
            raise CaretreeError(
                f"person '{self.name}': arms of {self.arm_masses.sum():g} kg on springs of {self.shoulder_spring:g} "
                "N m/rad, but arms weigh something and springs draw back"
            )

    @property
    def arm_radii(self) -> np.ndarray:
        """(3,) radii of this person's `ARM_SEGMENTS` [m]."""
        return np.array(self.radii) * self.scale

    @property
    def arm_lengths(self) -> np.ndarray:
        """(3,) lengths of this person's `ARM_SEGMENTS` [m]."""
        return np.array(self.lengths) * self.scale

    @property
    def arm_masses(self) -> np.ndarray:
        """(3,) masses of this person's `ARM_SEGMENTS` [kg]."""
        return np.array(SHAPE.segment_mass_shares) * (self.arm_mass + self.arm_mass_added)

    @property
    def arm_mass(self) -> float:
        """Mass of an arm by the share it has in the body's, without what is added [kg]."""
        return self.mass * SHAPE.arm_mass_share

    @property
    def trunk_mass(self) -> float:
        """Mass without the arms [kg]."""
        return self.mass * (1 - 2 * SHAPE.arm_mass_share)


PERSONS: dict[str, PersonSpec] = {
    spec.name: spec
    for spec in (
        PersonSpec(),
        PersonSpec(name="small", scale=0.93, mass=15.5, dry_friction=(2.0, 1.0), viscous=3.0),
        PersonSpec(name="stiff", scale=1.03, mass=19.5, dry_friction=(2.8, 1.5), viscous=5.0),
    )
}


def arm_part(arm: int, segment: int) -> int:
    """Index in `PERSON_PARTS` of a segment of the left (0) or right (1) arm."""
    return 1 + len(ARM_SEGMENTS) * arm + segment


def shoulder_in_map(spec: PersonSpec, side: Side, bed_top: float, bed_xy: tuple[float, float]) -> np.ndarray:
    """Centre of a shoulder joint (3,) [m]; the person's left is at smaller x."""
    return np.array(
        [
            bed_xy[0] + OUTWARD[side] * SHAPE.shoulder_x * spec.scale,
            bed_xy[1] - SHAPE.shoulder_y,
            bed_top + SHAPE.shoulder_z,
        ]
    )


def trunk_capsules(spec: PersonSpec, bed_top: float, bed_xy: tuple[float, float]) -> dict[str, Capsule]:
    """Chest with belly, legs, neck with head as name -> (end, end, radius) in the map frame [m]."""
    s, (x, y), z, body = spec.scale, bed_xy, bed_top, SHAPE
    out = {}
    for side in SIDES:
        sign, level = OUTWARD[side], z + body.chest_radius * s
        chest = x + sign * body.chest_x * s
        out[f"trunk_{side}"] = ((chest, y - body.chest_y, level), (chest, y, level), body.chest_radius * s)
        out[f"leg_{side}"] = (
            (x + sign * body.hip_x * s, y + body.hip_y, z + body.hip_z * s),
            (x + sign * body.foot_x * s, y + body.foot_y * s, z + body.foot_z * s),
            body.leg_radius * s,
        )
    # between both lies no valley: a chest is flat there, and cloth that sank in could not be grasped
    level = z + body.chest_radius * s
    out["trunk_middle"] = ((x, y - body.chest_y, level), (x, y, level), body.chest_radius * s)
    shoulders = y - body.shoulder_y
    out["neck_head"] = (
        (x, shoulders - body.neck_y * s, z + body.neck_z * s),
        (x, shoulders - body.head_y * s, z + body.head_z * s),
        body.head_radius * s,
    )
    return {name: (np.array(a), np.array(b), radius) for name, (a, b, radius) in out.items()}


def part_of(capsule: str) -> int:
    """Index in `PERSON_PARTS` of what one of `trunk_capsules` belongs to."""
    part = "head" if "head" in capsule else "legs" if "leg" in capsule else "trunk"
    return PERSON_PARTS.index(part)


def face(spec: PersonSpec, bed_top: float, bed_xy: tuple[float, float]) -> np.ndarray:
    """(6,) point on the skin between mouth and nose and the outward normal there, map frame [m]."""
    s, body = spec.scale, SHAPE
    share = (body.face_y - body.neck_y) / (body.head_y - body.neck_y)
    level = body.neck_z + share * (body.head_z - body.neck_z)
    y = bed_xy[1] - body.shoulder_y - body.face_y * s
    return np.array((bed_xy[0], y, bed_top + (level + body.head_radius) * s, 0.0, 0.0, 1.0))


def torso_front(spec: PersonSpec, bed_top: float, bed_xy: tuple[float, float]) -> np.ndarray:
    """(m, 6) points on the front of the trunk with outward normals, chest to waist, map frame [m]."""
    s, body = spec.scale, SHAPE
    side, radius = body.chest_x * s, body.chest_radius * s
    out = []
    for y in np.linspace(-body.chest_y, -body.front_y, 12):
        for x in np.linspace(-body.front_x, body.front_x, 11) * s:
            centre = np.copysign(side, x) if abs(x) > side else x
            lift = np.sqrt(radius**2 - (x - centre) ** 2)
            normal = np.array([x - centre, 0.0, lift]) / radius
            out.append((bed_xy[0] + x, bed_xy[1] + y, bed_top + radius + lift, *normal))
    return np.array(out)
