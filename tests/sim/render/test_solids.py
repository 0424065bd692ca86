"""Meshes of solids are closed, wound outwards and of the right size."""

import numpy as np
import pytest
from caretree.sim.render.solids import box_mesh, capsule_mesh, cylinder_mesh, sphere_mesh

A, B = np.array((0.2, -0.1, 0.3)), np.array((0.5, 0.4, 0.9))  # [m]
LENGTH = float(np.linalg.norm(B - A))


def volume(mesh):
    """Enclosed by a closed mesh whose faces wind outwards [m^3]."""
    vertices, faces = mesh
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


@pytest.mark.parametrize(
    ("mesh", "expected"),
    [
        (box_mesh(A, B), 0.3 * 0.5 * 0.6),
        (cylinder_mesh(A, B, 0.1, sides=96), np.pi * 0.01 * LENGTH),
        (sphere_mesh(A, 0.1, sides=96), 4 / 3 * np.pi * 0.001),
        (capsule_mesh(A, B, 0.1, sides=96), np.pi * 0.01 * LENGTH + 4 / 3 * np.pi * 0.001),
    ],
    ids=["box", "cylinder", "ball", "capsule"],
)
def test_encloses_its_volume(mesh, expected):
    assert volume(mesh) == pytest.approx(expected, rel=0.005)


def test_a_capsule_keeps_its_radius_about_its_axis():
    vertices, _ = capsule_mesh(A, B, 0.1)
    along = np.clip((vertices - A) @ (B - A) / LENGTH**2, 0.0, 1.0)
    distance = np.linalg.norm(vertices - A - along[:, None] * (B - A), axis=1)
    assert distance == pytest.approx(np.full(len(vertices), 0.1))


def test_a_box_has_the_corners_it_was_given():
    vertices, _ = box_mesh(A, B)
    assert vertices.min(axis=0) == pytest.approx(A)
    assert vertices.max(axis=0) == pytest.approx(B)
