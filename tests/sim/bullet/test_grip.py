"""Closing the fingers takes exactly the cloth between them."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.sim.bullet.grip import cloth_between
from caretree.sim.scene.gown import GOWNS, build_gown

DOWN = np.diag((1.0, -1.0, -1.0, 1.0))  # fingers point down, closing along y


def at(x: float, y: float, z: float) -> np.ndarray:
    pose = DOWN.copy()
    pose[:3, 3] = x, y, z
    return pose


@pytest.fixture(scope="module")
def flat():
    mesh = build_gown(GOWNS["medium"])
    vertices = np.stack([mesh.vertices[:, 0], -mesh.vertices[:, 2], mesh.vertices[:, 1]], axis=1)  # lies on z = 0
    return mesh, vertices


def test_a_flat_sheet_is_one_layer(flat):
    mesh, vertices = flat
    pinched = cloth_between(vertices, mesh.faces, at(0.0, 0.5, -0.01), 0.05)
    assert pinched.layers == 1
    assert 3 <= len(pinched.vertices) <= 9
    assert np.linalg.norm(vertices[list(pinched.vertices)] - (0.0, 0.5, 0.0), axis=1).max() < 0.09


def test_two_sheets_are_two_layers(flat):
    mesh, vertices = flat
    folded = np.vstack([vertices, vertices + (0.0, 0.0, 0.01)])
    faces = np.vstack([mesh.faces, mesh.faces + len(vertices)])
    assert cloth_between(folded, faces, at(0.0, 0.5, -0.01), 0.05).layers == 2


@pytest.mark.parametrize("where", [(0.0, 0.5, 0.05), (0.0, 0.5, -0.10), (0.0, -0.3, -0.01), (3.0, 0.5, -0.01)])
def test_beside_the_cloth_there_is_nothing(flat, where):
    mesh, vertices = flat
    assert cloth_between(vertices, mesh.faces, at(*where), 0.05).layers == 0


def test_the_edge_is_caught_only_as_far_as_the_fingers_reach(flat):
    mesh, vertices = flat
    assert cloth_between(vertices, mesh.faces, at(0.0, -0.02, -0.01), 0.06).layers == 1
    assert cloth_between(vertices, mesh.faces, at(0.0, -0.04, -0.01), 0.06).layers == 0
