"""The corners of a gown on its hook, in the simulated room."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.hung_corner import hook, hung_corner, strips
from caretree.perception.hung_side import hung_side
from caretree.sim.bullet import BulletWorld

STAND = 1.0  # of the base before the hook [m]
UP = np.array((0.0, 0.0, 1.0))


class Hung:
    """One seed's gown on its hook, seen by the robot's head camera, and what is true of it."""

    def __init__(self, seed: int) -> None:
        self.world = BulletWorld(seed=seed)
        self.hook = np.array((*self.world.scene.rail_xy, 1.55))
        facing_front = np.cos(self.world.scene.hang_yaw) < 0.0  # the outside is on the side of `rail`
        self.outside, self.inside = ("rail", "rail_back") if facing_front else ("rail_back", "rail")

    def frame(self, waypoint: str):
        yaw = self.world.room.waypoints[waypoint][2]
        ahead = np.array((np.cos(yaw), np.sin(yaw), 0.0))
        stand = self.hook - STAND * ahead
        self.world._robot = self.world._stand((float(stand[0]), float(stand[1]), yaw))
        return self.world.look("head"), ahead

    def corner(self, n: int) -> np.ndarray:
        return self.world._vertices_now()[self.world.scene.mesh.corners[n]]

    def raise_left(self, ahead: np.ndarray) -> float:
        """Draw the left corner aside and up with a free-flying hand; returns its distance from the hook [m]."""
        world, mesh = self.world, self.world.scene.mesh
        handle, start = world._handles[0], self.corner(0)
        pose = np.eye(4)
        pose[:3, 3] = start
        handle.reset(pose)
        near = np.argsort(np.linalg.norm(mesh.vertices - mesh.vertices[mesh.corners[0]], axis=1))[:3]
        world._cloth.pin(near, handle.body, handle.link)
        length = float(np.linalg.norm(start - self.hook))
        away = np.cos(0.52) * np.cross(ahead, UP) + np.sin(0.52) * ahead
        goal = self.hook + np.sqrt((0.95 * length) ** 2 - 0.16**2) * away + 0.16 * UP
        for k in range(1200):
            pose[:3, 3] = start + min(1.0, k / 800) * (goal - start)
            handle.follow(pose)
            world._hook.before_step()
            world._client.stepSimulation()
        world._vertices = world._cloth.vertices()
        return length


@pytest.fixture(scope="module", params=[1, 12])
def hung(request):
    """Two gowns; the second one's right corner hangs in a fold at first."""
    scene = Hung(request.param)
    yield scene
    scene.world.close()


def test_each_corner_where_it_is(hung):
    frame, ahead = hung.frame(hung.outside)
    top = hook(frame).position_in_map
    assert np.linalg.norm(top - hung.hook) < 0.03
    left = hung_corner(frame, "left")
    assert np.linalg.norm(left.position_in_map - hung.corner(0)) < 0.03
    assert abs(left.approach_in_map[2]) < 1e-9
    told = [strip for strip in strips(frame, top) if np.linalg.norm(strip.corner_in_map - hung.corner(0)) < 0.03]
    assert told
    assert told[0].tells < 0.0
    length = hung.raise_left(ahead)
    aside, _ = hung.frame(hung.outside)
    right = hung_corner(aside, "right", hook_in_map=top, other_length=length)
    assert np.linalg.norm(right.position_in_map - hung.corner(1)) < 0.05
    again = hung_corner(aside, "right", hook_in_map=top, near_in_map=right.position_in_map)
    assert np.linalg.norm(again.position_in_map - right.position_in_map) < 0.05
    with pytest.raises(PerceptionFailure):
        hung_corner(aside, "right", hook_in_map=top, near_in_map=right.position_in_map + 0.3)


def test_the_side_by_the_panel_below_the_hook():
    hung = Hung(6)  # its sleeves show more of the inside on the outside's side
    assert hung_side(hung.frame(hung.outside)[0]).outside
    assert not hung_side(hung.frame(hung.inside)[0]).outside
    hung.world.close()


def test_no_gown_no_corner(black):
    for look in (hook, hung_side, lambda frame: hung_corner(frame, "left")):
        with pytest.raises(PerceptionFailure):
            look(black)
