"""A towel, a client with PyBullet's rigid bodies, and what is in it."""

import numpy as np
import pytest
from caretree.sim.bullet_client import direct_client
from caretree.sim.scene.objects import Sheet as Towel
from caretree.sim.scene.objects import sheet_mesh
from caretree.sim.spring.room import SpringRoom

DT = 0.0025  # [s]


@pytest.fixture
def towel():
    """(mesh) of 0.4 m x 0.4 m, 0.2 kg."""
    return sheet_mesh(Towel(name="towel", size=(0.4, 0.4), position_in_map=(0.0, 0.0, 1.0), friction=0.8))


@pytest.fixture
def client():
    """A PyBullet of its own, in plain SI."""
    client = direct_client()
    yield client
    client.disconnect()


@pytest.fixture
def room():
    """An empty room of springs."""
    room = SpringRoom(DT)
    yield room
    room.close()


def block(client, size, place, mass=0.0, friction=0.5):
    """A box with edges `size` [m]."""
    shape = client.createCollisionShape(client.GEOM_BOX, halfExtents=[edge / 2 for edge in size])
    body = client.createMultiBody(mass, shape, basePosition=place)
    client.changeDynamics(body, -1, lateralFriction=friction, linearDamping=0.0, angularDamping=0.0)
    return body


def log(client, radius, length, place, turn=(np.pi / 2, 0.0, 0.0), mass=0.0, friction=0.5):
    """A capsule along y unless `turn` says otherwise [m]."""
    shape = client.createCollisionShape(client.GEOM_CAPSULE, radius=radius, height=length)
    body = client.createMultiBody(
        mass, shape, basePosition=place, baseOrientation=client.getQuaternionFromEuler(list(turn))
    )
    client.changeDynamics(body, -1, lateralFriction=friction, linearDamping=0.0, angularDamping=0.0)
    return body
