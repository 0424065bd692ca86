"""Persons whose arms fall."""

import numpy as np
import pytest
from caretree.sim.scene.difficulties import SIZES
from caretree.sim.scene.person_spec import SHAPE
from caretree.sim.scene.scene import BED_HALF, draw_scene
from caretree.sim.world import SIDES
from caretree.sim.world_kind import WorldKind

FALLING = WorldKind.named("easy+falling_arms")
PERSONS = [draw_scene(seed, kind=FALLING).person for seed in range(100, 140)]


@pytest.mark.parametrize("person", PERSONS[:10])
def test_an_arm_weighs_what_arms_do_and_friction_is_far_below_gravity(person):
    weights, lengths = 9.81 * person.arm_masses, person.arm_lengths
    assert 2.5 <= person.arm_masses.sum() <= 4.5
    at_elbow = weights[1] * lengths[1] / 2 + weights[2] * (lengths[1] + lengths[2] / 2)
    at_shoulder = at_elbow + lengths[0] * weights[1:].sum() + weights[0] * lengths[0] / 2
    assert person.dry_friction[0] < 0.2 * at_shoulder
    assert person.dry_friction[1] < 0.4 * at_elbow


def test_arms_lie_beside_the_trunk_on_the_bed_bent_and_spread_as_asked_for():
    angles = []
    for person in PERSONS:
        for side in SIDES:
            abduction, _, _, flexion = person.pose[side]
            angles.append((abduction, flexion))
            heading = np.array((abduction, abduction - flexion, abduction - flexion))
            along = SHAPE.shoulder_x * person.scale + np.cumsum(person.arm_lengths * np.sin(heading))
            assert along.max() < BED_HALF[0]
            assert along[1:].min() > (SHAPE.chest_x + SHAPE.chest_radius) * person.scale
    low, high = np.rad2deg(np.min(angles, axis=0)), np.rad2deg(np.max(angles, axis=0))
    assert (low >= (10, 0)).all()
    assert (low < (20, 10)).all()
    assert (high <= (60, 90)).all()
    assert (high > (55, 75)).all()


def test_a_shoulder_is_stiff_now_and_then_and_lies_within_its_range():
    stiff = [(person, side) for person in PERSONS for side in person.stiff]
    assert 0.05 < len(stiff) / (2 * len(PERSONS)) < 0.3
    for person, side in stiff:
        shoulder = person.stiff[side]
        assert shoulder.dry_friction > 2 * person.dry_friction[0] or shoulder.dry_friction >= 2.0
        assert person.pose[side][0] < shoulder.abduction_end
        assert person.pose[side][1] < shoulder.elevation_end


def test_the_rest_of_the_scene_does_not_change():
    easy, falling = draw_scene(100), draw_scene(100, kind=FALLING)
    assert not easy.person.falls
    assert falling.person.falls
    for same in ("gown", "bed_xy", "rail_xy", "hang_vertex", "hang_yaw"):
        assert getattr(easy, same) == getattr(falling, same)
    assert (easy.person.name, easy.person.scale) == (falling.person.name, falling.person.scale)
    assert falling.person == draw_scene(100, kind=FALLING).person
    assert SIZES.falling_arms.body_mass[0] <= falling.person.mass <= SIZES.falling_arms.body_mass[1]
