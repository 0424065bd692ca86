"""The shoulders of a gown on its hook, in the simulated room."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.hung_sleeve import hung_sleeve
from caretree.sim.bullet import BulletWorld


@pytest.fixture(scope="module", params=[2, 7])
def seen(request):
    """A head camera's frame of the gown's outside, and where its collar's corners are (2, 3): left, right."""
    world = BulletWorld(seed=request.param)
    facing_front = np.cos(world.scene.hang_yaw) < 0.0  # the outside is on the side of `rail`
    world._robot = world._stand(world.room.waypoints["rail" if facing_front else "rail_back"])
    corners = world._cloth.vertices()[list(world.scene.mesh.corners)]
    yield world.look("head"), corners
    world.close()


@pytest.mark.parametrize(("side", "n"), [("left", 0), ("right", 1)])
def test_each_hand_gets_its_shoulder(seen, side, n):
    frame, corners = seen
    grasp = hung_sleeve(frame, side)
    assert np.linalg.norm(grasp.position_in_map - corners[n]) < 0.20
    lateral = frame.pose_camera_in_map[:3, 0]
    other = hung_sleeve(frame, "right" if side == "left" else "left")
    outward = 1.0 if side == "left" else -1.0  # seen from outside, the wearer's left is on the right of the picture
    assert outward * (grasp.position_in_map - other.position_in_map) @ lateral > 0.0
    assert abs(grasp.approach_in_map[2]) < 1e-9


def test_no_gown_no_shoulder(seen):
    frame, _ = seen
    black = dataclasses.replace(frame, rgb=np.zeros_like(frame.rgb))
    with pytest.raises(PerceptionFailure):
        hung_sleeve(black, "left")
