"""Closing the fingers takes exactly the cloth between them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from caretree.sim.bullet.grip import TOUCH, Grip, cloth_between
from caretree.sim.bullet.handle import Handle
from caretree.sim.bullet.person import Person
from caretree.sim.bullet_client import direct_client
from caretree.sim.scene.gown import GOWNS, build_gown
from caretree.sim.scene.scene import BED_TOP, draw_scene

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


@pytest.fixture
def around_forearm():
    """A grip whose fingers stand open around the right forearm, the pose of their hand, and how thick the arm is."""
    scene = draw_scene(0)
    room = direct_client()
    person = Person(room, scene.person, BED_TOP, scene.bed_xy)
    a, b = person.arms()[1, 1:3]
    along = (b - a) / np.linalg.norm(b - a)
    across = np.cross(along, (0.0, 0.0, 1.0))
    across /= np.linalg.norm(across)
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack((along, -across, np.cross(along, -across)))
    pose[:3, 3] = a + 0.24 * (b - a)
    yield Grip(room, "left", Handle(room, pose), SimpleNamespace(), person), pose, 2 * float(person.radii()[1, 1])
    room.disconnect()


def closed_slowly(grip, pose, *, to, lag=0.002, step=0.0014):
    """Opening at which fingers that close by a step at a time, a little late, take an arm; None for none [m]."""
    told = 0.085
    while told > to:
        told -= step
        grip.on_command(told, told + lag)
        if grip.catch_arm(pose, told + lag, 28.0):
            return told + lag
    return None


@pytest.mark.parametrize("before", [0, 1, 2])
def test_fingers_that_close_step_by_step_take_the_part_of_the_arm_between_them_each_time(around_forearm, before):
    grip, pose, thick = around_forearm
    for _ in range(before):
        assert closed_slowly(grip, pose, to=0.05)
        grip.on_command(0.085, thick)
        grip.release()
        grip.on_command(0.085, 0.085)
    assert closed_slowly(grip, pose, to=0.05) == pytest.approx(thick + TOUCH, abs=0.002)
    assert grip.thickness == pytest.approx(thick)


def test_at_the_elbow_the_thicker_part_is_taken_which_the_fingers_touch_first(around_forearm):
    grip, pose, thick = around_forearm
    upper = 2 * float(grip.person.radii()[1, 0])
    pose[:3, 3] = grip.person.arms()[1, 1] + 0.001 * pose[:3, 0]  # a hair nearer to the forearm
    assert closed_slowly(grip, pose, to=0.05) == pytest.approx(upper + TOUCH, abs=0.002)
    assert upper > thick + TOUCH


def test_a_part_that_ends_before_it_comes_between_the_fingers_is_not_taken(around_forearm):
    grip, pose, thick = around_forearm
    grip.on_command(0.0, thick - 0.004)  # too narrow for the forearm, wide enough for the hand 0.15 m away
    assert not grip.catch_arm(pose, 0.04, 28.0)


def test_fingers_that_open_do_not_take_an_arm(around_forearm):
    grip, pose, _ = around_forearm
    grip.on_command(0.0, 0.085)
    grip.on_command(0.085, 0.05)
    assert not grip.catch_arm(pose, 0.055, 28.0)
