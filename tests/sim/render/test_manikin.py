"""The person people see stays inside the capsules that cloth and robot meet."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.sim.render.manikin import arm_parts, lying_parts
from caretree.sim.scene.person_spec import PersonSpec, trunk_capsules

TRUNK = trunk_capsules(PersonSpec(), 0.6, (0.0, 0.0))


def test_the_lying_body_is_complete_and_has_a_face():
    parts = {name: (mesh, colour) for name, mesh, colour in lying_parts(TRUNK)}
    assert {"torso", "leg_left", "leg_right", "head", "hair", "eyes", "mouth"} <= set(parts)
    for (vertices, faces), _ in parts.values():
        assert np.isfinite(vertices).all()
        assert faces.min() >= 0
        assert faces.max() < len(vertices)
    assert parts["mouth"][0][0][:, 2].mean() > TRUNK["neck_head"][0][2], "it looks up"
    assert parts["eyes"][0][0][:, 1].mean() < parts["mouth"][0][0][:, 1].mean(), "the crown is at the head of the bed"


@pytest.mark.parametrize("side", [0, 1])
def test_limbs_reach_from_joint_to_joint_within_their_capsules(side):
    radii, lengths = (0.04, 0.035, 0.03), (0.3, 0.25, 0.18)
    for k, (vertices, _) in enumerate(arm_parts(radii, lengths, side)[:2]):
        beside = vertices - np.clip(vertices[:, 2:], 0.0, lengths[k]) * (0.0, 0.0, 1.0)
        assert np.linalg.norm(beside, axis=1).max() <= radii[k] + 1e-9
        assert vertices[:, 2].max() > lengths[k]
    hand, _ = arm_parts(radii, lengths, side)[2]
    assert lengths[2] - 0.01 < hand[:, 2].max() < lengths[2] + 0.01


@pytest.mark.parametrize("leg", ["leg_left", "leg_right"])
def test_feet_are_in_the_legs_capsules_as_cloth_lies_on_those(leg):
    start, end, radius = (np.asarray(value, float) for value in TRUNK[leg])
    axis = end - start
    vertices = dict((name, mesh[0]) for name, mesh, _ in lying_parts(TRUNK))[leg]
    along = np.clip((vertices - start) @ axis / (axis @ axis), 0.0, 1.0)
    assert np.linalg.norm(vertices - start - along[:, None] * axis, axis=1).max() <= radius + 1e-9
    assert (vertices @ axis).max() > end @ axis + 0.5 * radius * np.linalg.norm(axis), "it has a foot"


def test_thumbs_are_on_opposite_sides():
    left, right = (arm_parts((0.04, 0.035, 0.03), (0.3, 0.25, 0.18), side)[2][0] for side in (0, 1))
    assert left[:, 1].max() > -left[:, 1].min()
    assert right[:, 1].max() < -right[:, 1].min()
