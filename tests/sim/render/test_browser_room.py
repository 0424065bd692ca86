"""Only what has moved is sent to the browser."""

from __future__ import annotations

import numpy as np
from caretree.sim.render.browser_room import BrowserRoom
from caretree.sim.render.camera import Renderer
from caretree.sim.render.raster import Light
from caretree.sim.render.solids import box_mesh

SHEET = np.array([(0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (0.0, 1.0, 1.0), (1.0, 1.0, 1.0)])


class Scene:
    """Keeps the meshes, and counts what is set on them."""

    def __init__(self):
        self.meshes, self.sent = {}, []

    def set_up_direction(self, direction):
        pass

    def add_mesh_simple(self, name, vertices, faces, **options):
        scene = self

        class Mesh:
            def __setattr__(self, attribute, value):
                scene.sent.append((name, attribute))
                self.__dict__[attribute] = value

            def remove(self):
                del scene.meshes[name]

        mesh = self.meshes[name] = Mesh()
        mesh.__dict__.update(vertices=vertices, faces=faces, **options)
        return mesh


def test_what_stands_still_is_sent_once():
    renderer = Renderer(Light(direction_in_map=np.array((0.0, 0.0, 1.0))))
    for name in ("bed", "robot_palm", "ceiling"):
        renderer.add_rigid(name, *box_mesh(np.zeros(3), np.ones(3)), (10, 20, 300))
    faces, colours = np.array([(0, 1, 2), (1, 3, 2)]), np.array([(9.0, 9, 9), (200.0, 0, 0)])
    renderer.set_cloth(SHEET, faces, colours, colours)
    scene = Scene()
    room = BrowserRoom(scene)
    room.show(0.0, renderer)
    assert set(scene.meshes) == {
        "/room/bed",
        "/room/robot_palm",
        *(f"/cloth/{s}" for s in ("front_0", "front_1", "back_2", "back_3")),
    }
    assert scene.meshes["/room/bed"].color == (10, 20, 255)
    scene.sent.clear()
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = np.diag((-1.0, -1.0, 1.0)), (1.0, 2.0, 3.0)
    renderer.set_pose("robot_palm", pose)
    renderer.move_cloth(SHEET + 1.0)
    room.show(0.1, renderer)
    assert {name for name, _ in scene.sent if name.startswith("/room")} == {"/room/robot_palm"}
    np.testing.assert_allclose(np.abs(scene.meshes["/room/robot_palm"].wxyz), (0, 0, 0, 1), atol=1e-9)
    np.testing.assert_allclose(scene.meshes["/cloth/front_1"].vertices, SHEET[[1, 2, 3]] + 1.0)
    renderer.remove_cloth()
    room.show(0.2, renderer)
    assert set(scene.meshes) == {"/room/bed", "/room/robot_palm"}
