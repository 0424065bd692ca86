"""Drawing a person whose arms fall and whose elbows bend; sizes in `difficulties.py`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..world import SIDES
from .difficulties import SIZES, FallingArms
from .person_spec import LYING_ELEVATION, LYING_ROTATION, SHAPE, PersonSpec, StiffShoulder


def with_falling_arms(
    person: PersonSpec, rng: np.random.Generator, bed_half_width: float, sizes: FallingArms = SIZES.falling_arms
) -> PersonSpec:
    """`person` with the weight of a grown body, limp arms laid beside it, and now and then a stiff shoulder.

    Args:
        person: whose size stays.
        rng: of this difficulty alone.
        bed_half_width: from the middle of the bed to its edge [m].
        sizes: how heavy, how limp, how bent.
    """
    return replace(
        person,
        mass=float(rng.uniform(*sizes.body_mass)),
        dry_friction=(float(rng.uniform(*sizes.shoulder_friction)), float(rng.uniform(*sizes.elbow_friction))),
        viscous=float(rng.uniform(*sizes.viscous)),
        pose={side: _lying_pose(person, rng, bed_half_width, sizes) for side in SIDES},
        stiff={side: shoulder for side in SIDES if (shoulder := _stiff_shoulder(rng, sizes))},
        stirring=sizes.stirring,
        falls=True,
    )


def _lying_pose(
    person: PersonSpec, rng: np.random.Generator, bed_half_width: float, sizes: FallingArms
) -> tuple[float, float, float, float]:
    """Joints of an arm that lies on the bed from shoulder to fingertip, drawn until it does."""
    upper, fore, hand = person.arm_lengths
    shoulder, flank = SHAPE.shoulder_x * person.scale, (SHAPE.chest_x + SHAPE.chest_radius) * person.scale
    thickness = person.arm_radii[1:]
    while True:
        abduction, flexion = rng.uniform(*sizes.abduction), rng.uniform(*sizes.flexion)
        elbow = shoulder + upper * np.sin(abduction)
        ends = elbow + np.array((fore, fore + hand)) * np.sin(abduction - flexion)  # wrist and fingertip
        beside = (ends - thickness > flank + sizes.clearance).all()
        if beside and (ends + thickness < bed_half_width - sizes.clearance).all():
            return float(abduction), LYING_ELEVATION, LYING_ROTATION, float(flexion)


def _stiff_shoulder(rng: np.random.Generator, sizes: FallingArms) -> StiffShoulder | None:
    """One that is stiff, as often as `stiff_share`; as many numbers are drawn either way."""
    share, friction, elevation, abduction = rng.uniform(size=4)
    if share >= sizes.stiff_share:
        return None

    def between(low_high: tuple[float, float], at: float) -> float:
        return float(low_high[0] + at * (low_high[1] - low_high[0]))

    return StiffShoulder(
        dry_friction=between(sizes.stiff_friction, friction),
        elevation_end=between(sizes.stiff_elevation, elevation),
        abduction_end=between(sizes.stiff_abduction, abduction),
        end_stiffness=sizes.end_stiffness,
    )
