"""Bed and floor carry what falls on them."""

from __future__ import annotations

import pytest
from caretree.sim.bullet.furniture import add_furniture
from caretree.sim.bullet.soft_world import GRAVITY
from caretree.sim.bullet_client import direct_client
from caretree.sim.scene.scene import BED_HALF, BED_TOP


@pytest.mark.parametrize(("beside", "height"), [(0.0, BED_TOP), (2 * BED_HALF[0], 0.0)])
def test_a_ball_comes_to_rest_on_the_bed_or_on_the_floor(beside, height):
    client = direct_client()
    client.setGravity(0, 0, -GRAVITY)
    add_furniture(client, (0.1, -0.05))
    ball = client.createMultiBody(
        1.0, client.createCollisionShape(client.GEOM_SPHERE, radius=0.05), basePosition=(0.1 + beside, -0.05, 1.0)
    )
    for _ in range(600):
        client.stepSimulation()
    assert client.getBasePositionAndOrientation(ball)[0][2] == pytest.approx(height + 0.05, abs=0.005)
    client.disconnect()
