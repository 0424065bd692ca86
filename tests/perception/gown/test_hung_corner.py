"""The corners of a gown on its hook, in the simulated room."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.gown.hung_corner import hook, hung_corner, shown_corner
from caretree.perception.gown.hung_side import hung_side
from caretree.sim.bullet.grip import cloth_between
from caretree.sim.bullet.world import BulletWorld
from caretree.skills.motion.ik import hand_pose

STAND = 1.0  # of the base before the hook [m]
VIEWS = np.deg2rad((0.0, -30.0, 30.0))  # about the hook, from where the robot looks for a corner [rad]
UP = np.array((0.0, 0.0, 1.0))
PART = 0.21  # confidence up to which a corner shows in part only


class Hung:
    """One seed's gown on its hook, seen by the robot's head camera, and what is true of it."""

    def __init__(self, seed: int) -> None:
        self.world = BulletWorld(seed=seed)
        self.hook = np.array((*self.world.scene.rail_xy, 1.55))
        facing_front = np.cos(self.world.scene.hang_yaw) < 0.0  # the outside is on the side of `rail`
        self.outside, self.inside = ("rail", "rail_back") if facing_front else ("rail_back", "rail")

    def frame(self, waypoint: str, turn: float = 0.0):
        yaw = self.world.room.waypoints[waypoint][2] + turn
        ahead = np.array((np.cos(yaw), np.sin(yaw), 0.0))
        stand = self.hook - STAND * ahead
        self.world._robot = self.world._stand((float(stand[0]), float(stand[1]), yaw))
        return self.world.look("head"), ahead

    def corner(self, n: int) -> np.ndarray:
        return self.world._vertices_now()[self.world.scene.mesh.corners[n]]

    def raise_corner(self, n: int, ahead: np.ndarray) -> float:
        """Draw one corner aside and up with a free-flying hand; returns its distance from the hook [m]."""
        world, mesh = self.world, self.world.scene.mesh
        handle, start = world._handles[0], self.corner(n)
        pose = np.eye(4)
        pose[:3, 3] = start
        handle.reset(pose)
        near = np.argsort(np.linalg.norm(mesh.vertices - mesh.vertices[mesh.corners[n]], axis=1))[:3]
        world._cloth.pin(near, handle.body, handle.link)
        length = float(np.linalg.norm(start - self.hook))
        outwards = (1.0 if n == 0 else -1.0) * np.cross(ahead, UP)
        away = np.cos(0.52) * outwards + np.sin(0.52) * ahead
        goal = self.hook + np.sqrt((0.95 * length) ** 2 - 0.16**2) * away + 0.16 * UP
        for k in range(1200):
            pose[:3, 3] = start + min(1.0, k / 800) * (goal - start)
            handle.follow(pose)
            world._hook.before_step()
            world._client.stepSimulation()
        world._look_anew()
        return length

    def taken(self, grasp, opening: float, depth: float) -> tuple[int, int]:
        """Layers that fingers would take there, and how far the farthest of it is from the corner [cells]."""
        world, mesh = self.world, self.world.scene.mesh
        pose = hand_pose(
            grasp.position_in_map + depth * grasp.approach_in_map, grasp.approach_in_map, grasp.closing_in_map
        )
        pinched = cloth_between(world._vertices_now(), mesh.faces, pose, opening)
        corner = mesh.corners[0 if grasp.target == "collar_corner_left" else 1]
        far = np.linalg.norm(mesh.vertices[list(pinched.vertices)] - mesh.vertices[corner], axis=1).max()
        return pinched.layers, round(float(far) / mesh.spec.spacing)


@pytest.fixture(scope="module", params=[3, 13])
def hung(request):
    """Two gowns: the neckline of the first one hangs edge-on to a camera in front."""
    scene = Hung(request.param)
    yield scene
    scene.world.close()


def test_each_corner_where_it_is(hung):
    top = hook(hung.frame(hung.outside)[0]).position_in_map
    assert np.linalg.norm(top - hung.hook) < 0.03
    shown = ahead = turn = None
    for turn in VIEWS:
        frame, ahead = hung.frame(hung.outside, turn)
        try:
            shown = shown_corner(frame, top)
        except PerceptionFailure:
            continue
        if shown.confidence > PART:
            break
    assert shown is not None
    n = 0 if shown.target == "collar_corner_left" else 1
    assert np.linalg.norm(shown.position_in_map - hung.corner(n)) < 0.015
    assert abs(shown.approach_in_map[2]) < 1e-9
    assert hung.taken(shown, 0.04, 0.006) == (1, 1)
    first, second = ("left", "right") if n == 0 else ("right", "left")
    again = hung_corner(frame, first, top, near_in_map=shown.position_in_map)
    assert np.linalg.norm(again.position_in_map - shown.position_in_map) < 0.02
    length = hung.raise_corner(n, ahead)
    aside, _ = hung.frame(hung.outside, turn)
    other = hung_corner(aside, second, top, other_length=length)
    assert np.linalg.norm(other.position_in_map - hung.corner(1 - n)) < 0.04
    assert hung.taken(other, 0.035, 0.01) == (1, 1)
    with pytest.raises(PerceptionFailure):
        hung_corner(aside, second, top, near_in_map=other.position_in_map + 0.3)


def test_a_corner_that_is_seen_at_an_angle_counts_less():
    hung = Hung(130)
    hung.world.clock.wait_until(8.0)  # it hangs together by then
    seen = []
    for turn in VIEWS:
        frame, _ = hung.frame(hung.outside, turn)
        try:
            shown = shown_corner(frame, hook(frame).position_in_map)
        except PerceptionFailure:
            continue
        n = 0 if shown.target == "collar_corner_left" else 1
        assert np.linalg.norm(shown.position_in_map - hung.corner(n)) < 0.03
        seen.append(shown.confidence)
    assert seen
    assert max(seen) < PART
    hung.world.close()


def test_a_second_strip_that_is_seen_edge_on_ends_above_its_armhole():
    hung = Hung(141)
    hung.world.clock.wait_until(8.0)
    top = hook(hung.frame(hung.outside)[0]).position_in_map
    _, ahead = hung.frame(hung.outside)
    length = hung.raise_corner(0, ahead)
    errors = []
    for turn in VIEWS:
        frame, _ = hung.frame(hung.outside, turn)
        found = hung_corner(frame, "right", top, other_length=length)
        errors.append(np.linalg.norm(found.position_in_map - hung.corner(1)))
    assert max(errors) < 0.06
    hung.world.close()


def test_the_side_by_the_panel_below_the_hook():
    hung = Hung(6)  # its sleeves show more of the inside on the outside's side
    assert hung_side(hung.frame(hung.outside)[0]).outside
    assert not hung_side(hung.frame(hung.inside)[0]).outside
    hung.world.close()


def test_no_gown_no_corner(black):
    for look in (
        hook,
        hung_side,
        lambda frame: shown_corner(frame, np.zeros(3)),
        lambda frame: hung_corner(frame, "left", np.zeros(3)),
    ):
        with pytest.raises(PerceptionFailure):
            look(black)
