"""The armhole around a grip, in the simulated room: the gown hangs, the place of a grip is given."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.sleeve.held_armhole import held_armhole
from caretree.sim.bullet.world import BulletWorld


@pytest.fixture(scope="module")
def world():
    """A gown on its hook, the robot on the side of its outside."""
    world = BulletWorld(seed=7)
    world._robot = world._stand(world.room.waypoints["rail"])
    yield world
    world.close()


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_middle_of_the_armhole_is_found(world, side):
    ring = world._cloth.vertices()[world.scene.mesh.loops[f"armhole_{side}"]]
    grip = ring[0]
    seen = held_armhole(world.look("head"), side, grip)
    assert np.linalg.norm(seen.armhole_points_in_map - grip, axis=1).max() < 0.34
    lateral = world.look("head").pose_camera_in_map[:3, 0]
    # on the hook the other sleeve hangs within reach too and draws the middle towards it, but not over the grip
    other = world._cloth.vertices()[world.scene.mesh.loops["armhole_left" if side == "right" else "armhole_right"]]
    middle = (ring.mean(axis=0) + other.mean(axis=0)) / 2
    towards = (ring.mean(axis=0) - middle) @ lateral
    assert (seen.centre_in_map - middle) @ lateral * np.sign(towards) > -0.05
    assert seen.confidence > 0.5


def test_no_armhole_far_away(world):
    with pytest.raises(PerceptionFailure):
        held_armhole(world.look("head"), "left", np.array((0.0, 0.0, 3.0)))
