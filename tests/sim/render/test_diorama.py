"""What people watch follows what the robot's cameras are drawn from."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.sim.render.appearance import draw_appearance
from caretree.sim.render.camera import Renderer
from caretree.sim.render.diorama import Diorama, Furniture, along
from caretree.sim.render.raster import Light
from caretree.sim.render.solids import box_mesh
from caretree.sim.scene.person_spec import PersonSpec, trunk_capsules

LIGHT = Light(direction_in_map=np.array((0.0, 0.0, 1.0)))
SHEET = np.array([(0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (0.0, 1.0, 1.0)])


@pytest.fixture
def diorama():
    person = PersonSpec()
    lengths = np.tile(person.arm_lengths, (2, 1))
    furniture = Furniture(bed_xy=(0.0, 0.0), bed_top=0.6, rail=(2.7, 0.4, 1.55))
    look = draw_appearance(np.random.default_rng(0))
    return Diorama(look, furniture, trunk_capsules(person, 0.6, (0.0, 0.0)), np.tile(person.arm_radii, (2, 1)), lengths)


@pytest.fixture
def seen():
    renderer = Renderer(LIGHT)
    for name in ("robot_palm", "object_cup", "wall_back"):
        renderer.add_rigid(name, *box_mesh(np.zeros(3), np.ones(3)), (200, 0, 0))
    renderer.set_cloth(SHEET, np.array([(0, 1, 2)]), np.ones((1, 3)), np.ones((1, 3)))
    return renderer


def test_robot_objects_and_cloth_are_followed_and_the_room_is_its_own(diorama, seen):
    there = np.eye(4)
    there[:3, 3] = 1.0, 2.0, 3.0
    seen.set_pose("robot_palm", there)
    bodies = {body.name: body for body in diorama.follow(seen).bodies()}
    np.testing.assert_allclose(bodies["robot_palm"].pose_in_map, there)
    assert "object_cup" in bodies
    assert "wall_back" not in bodies
    np.testing.assert_allclose(diorama.renderer.cloth[0], SHEET)
    seen.move_cloth(SHEET + 1.0)
    seen.move_vertices("object_cup", 2.0 * box_mesh(np.zeros(3), np.ones(3))[0])
    bodies = {body.name: body for body in diorama.follow(seen).bodies()}
    np.testing.assert_allclose(diorama.renderer.cloth[0], SHEET + 1.0)
    assert bodies["object_cup"].vertices.max() == 2.0
    seen.remove_cloth()
    assert diorama.follow(seen).cloth is None


def test_the_room_is_closed(diorama):
    bodies = list(diorama.renderer.bodies())
    names = {body.name for body in bodies}
    assert {"floor", "ceiling", "wall_north", "wall_south", "wall_west", "wall_east"} <= names
    assert set(diorama.shell) == {diorama.renderer.ids[body.name] for body in bodies[: len(diorama.shell)]}


def test_capsules_stand_where_they_are_put(diorama):
    capsules = np.array([(0.0, 0.0, 1.0, 0.0, 0.5, 1.0, 0.05)])
    diorama.add_capsules(["left_forearm"], capsules)
    diorama.move_capsules(["left_forearm"], capsules + (1, 0, 0, 1, 0, 0, 0))
    body = next(body for body in diorama.renderer.bodies() if body.name == "link_left_forearm")
    ends = body.vertices @ body.pose_in_map[:3, :3].T + body.pose_in_map[:3, 3]
    np.testing.assert_allclose([ends[:, 1].min(), ends[:, 1].max()], [-0.05, 0.55], atol=1e-9)
    np.testing.assert_allclose(ends[:, 0].mean(), 1.0, atol=1e-9)


def test_a_pose_along_nothing_is_still_a_pose():
    for b in ((0.0, 0.0, 0.0), (0.0, 1.0, 0.1), (1.0, 0.0, 0.0)):
        pose = along(np.zeros(3), np.array(b))
        assert np.isfinite(pose).all()
