"""What is read of a client's bodies, and what they are given."""

import numpy as np
import pytest
from caretree.sim.spring.solids import JUMP, Solids, matrix

from .conftest import DT, block, log


def test_capsules_balls_and_boxes_are_where_they_are(client):
    log(client, 0.05, 0.4, (1, 0, 0.5), friction=0.3)
    client.createMultiBody(0, client.createCollisionShape(client.GEOM_SPHERE, radius=0.2), basePosition=(0, 0, 2))
    block(client, (1, 2, 0.5), (0, 0, 0.25), friction=0.7)
    solids = Solids(client, 1.0)
    assert sorted(solids.capsules[0, :, 1]) == pytest.approx([-0.2, 0.2])
    np.testing.assert_allclose(solids.capsules[0, :, [0, 2]], [[1, 1], [0.5, 0.5]], atol=1e-12)
    np.testing.assert_allclose(solids.capsules[1], [[0, 0, 2]] * 2)
    np.testing.assert_allclose(solids.radii, [0.05, 0.2])
    np.testing.assert_allclose(solids.boxes[0], [0, 0, 0.25, 0.5, 1, 0.25, *np.eye(3).ravel()])
    np.testing.assert_allclose(solids.friction, [0.3, 0.5, 0.7])


def test_speed_is_how_far_it_moved_unless_it_was_put_somewhere_else(client):
    body = log(client, 0.05, 0.4, (0, 0, 0), mass=1.0)
    turn = client.getQuaternionFromEuler([np.pi / 2, 0, 0])
    solids = Solids(client, 1.0)
    client.resetBasePositionAndOrientation(body, (0.001, 0, 0), turn)
    solids.read(DT)
    np.testing.assert_allclose(solids.speeds[0], [[0.001 / DT, 0, 0]] * 2, atol=1e-9)
    client.resetBasePositionAndOrientation(body, (0.001 + 2 * JUMP, 0, 0), turn)
    solids.read(DT)
    np.testing.assert_allclose(solids.speeds[0], 0.0)
    np.testing.assert_allclose(solids.capsules[0, :, 0], 0.001 + 2 * JUMP)


def test_bodies_that_come_later_are_seen(client):
    solids = Solids(client, 1.0)
    solids.read(DT)
    assert len(solids.radii) == 0
    assert not solids.changed
    log(client, 0.05, 0.4, (0, 0, 0))
    solids.read(DT)
    assert len(solids.radii) == 1
    assert solids.changed


def test_what_is_given_moves_what_can_move(client):
    still, loose = block(client, (1, 1, 1), (0, 0, 0)), block(client, (1, 1, 1), (5, 0, 0), mass=2.0)
    client.setTimeStep(DT)
    solids = Solids(client, 1.0)
    given = np.zeros((2, 7))
    given[:, 2], given[:, 3] = 0.4, 0.4  # 0.4 N s upwards, in the middle
    given[1, 4:] = 0.4 * np.array((5, 0, 0))
    solids.push(given, DT)
    client.stepSimulation()
    np.testing.assert_allclose(client.getBaseVelocity(loose)[0], (0, 0, 0.2), atol=1e-6)
    assert client.getBaseVelocity(still)[0] == (0, 0, 0)


def test_a_quaternion_is_its_rotation(client):
    turn = client.getQuaternionFromEuler([0.3, -0.7, 1.9])
    np.testing.assert_allclose(matrix(*turn).ravel(), client.getMatrixFromQuaternion(turn), atol=1e-12)
