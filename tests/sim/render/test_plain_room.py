"""A world without a picture of itself is shown as sensed."""

from __future__ import annotations

import numpy as np
from caretree.sim.render.plain_room import PlainRoom
from caretree.sim.scripted.world import ScriptedWorld


def test_base_and_hands_are_where_they_are_sensed():
    world = ScriptedWorld(seed=0)
    seen = world.observe()
    poses = {body.name: body.pose_in_map for body in PlainRoom(world.room).at(seen).bodies()}
    np.testing.assert_allclose(poses["base"][:2, 3], seen.pose_base_in_map[:2])
    np.testing.assert_allclose(poses["right_hand"], seen.pose_hand_in_map[1])
    assert "bed" in poses
