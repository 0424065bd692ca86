"""Known weights: what a hand and the person are said to feel is what physics says they carry."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from caretree.sim.bullet.cloth import Cloth, UnstableClothError
from caretree.sim.bullet.handle import Handle, roll_pitch_yaw
from caretree.sim.bullet.soft_world import GRAVITY, SoftWorld
from caretree.sim.scene.gown import GOWNS, build_gown


@pytest.fixture
def world():
    """An empty deformable world."""
    world = SoftWorld(0.0025)
    yield world
    world.close()


def hang(world: SoftWorld, mass: float) -> tuple[np.ndarray, Cloth]:
    spec = dataclasses.replace(GOWNS["medium"], mass=mass, damping=0.02)
    mesh = build_gown(spec)
    cloth = Cloth(world, mesh, mesh.vertices + (0.0, 0.0, 1.6))
    pose = np.eye(4)
    pose[:3, 3] = cloth.vertices()[mesh.collar[7]]
    handle = Handle(world.client, pose)
    near = np.argsort(np.linalg.norm(cloth.vertices() - pose[:3, 3], axis=1))[:4]
    cloth.pin(near, handle.body, handle.link)
    loads = []
    for k in range(2000):
        handle.follow(pose)
        world.step()
        if k >= 1000 and k % 10 == 0:
            loads.append(cloth.load(near, cloth.vertices()))
    assert np.abs(handle.position() - pose[:3, 3]).max() < 0.003
    return np.mean(loads, axis=0), cloth


@pytest.mark.parametrize("mass", [0.45, 0.9])
def test_a_hanging_gown_weighs_what_it_weighs(world, mass):
    load, cloth = hang(world, mass)
    assert load[2] == pytest.approx(-mass * GRAVITY, rel=0.02)
    assert np.abs(load[:2]).max() < 0.05 * mass * GRAVITY  # it still swings a little
    now, (a, b) = cloth.vertices(), cloth.edges.T
    assert np.percentile(np.linalg.norm(now[a] - now[b], axis=1) / cloth.rest_lengths, 99) < 1.25


def test_an_unstable_gown_is_refused(world):
    mesh = build_gown(dataclasses.replace(GOWNS["medium"], elastic=400.0))
    with pytest.raises(UnstableClothError, match=r"at most 0\.7 is stable"):
        Cloth(world, mesh, mesh.vertices)


@pytest.mark.parametrize(("free", "felt"), [(True, 0.3 * 2.0), (False, 8.3 * 2.0)])
def test_what_is_carried_quickly_is_felt_without_the_handle_if_asked(world, free, felt):
    pose = np.eye(4)
    pose[:3, 3] = (0.0, 0.0, 1.0)
    handle, c = Handle(world.client, pose), world.client
    body = c.createMultiBody(0.3, c.createCollisionShape(c.GEOM_SPHERE, radius=0.03), basePosition=(0.0, 0.0, 1.0))
    c.changeDynamics(body, -1, linearDamping=0.0, angularDamping=0.0)
    place = c.getLinkState(handle.body, handle.link, computeForwardKinematics=1)
    here = c.multiplyTransforms(*c.invertTransform((0, 0, 1), (0, 0, 0, 1)), place[4], place[5])
    c.createConstraint(
        *(handle.body, handle.link, body, -1, c.JOINT_FIXED, (0, 0, 0)),
        *((0, 0, 0), here[0], (0, 0, 0, 1), here[1]),
    )
    loads = []
    for k in range(200):  # 2 m/s^2 along x
        pose[0, 3] = 0.5 * 2.0 * (0.0025 * k) ** 2
        handle.follow(pose)
        world.step()
        handle.feel(0.0025 if free else None)
        loads.append(handle.load)
    mean = np.mean(loads[100:], axis=0)
    assert mean[0] == pytest.approx(-felt, rel=0.15)
    assert mean[2] == pytest.approx(-0.3 * GRAVITY, rel=0.05)


def test_a_handle_is_told_once_where_to_be_and_anew_after_it_was_put_elsewhere(world):
    here, there = np.eye(4), np.eye(4)
    there[:3, 3] = 0.3, 0.1, 0.2  # [m]
    handle = Handle(world.client, here)
    for _ in range(2):
        for _ in range(400):
            handle.follow(there)
            world.step()
        np.testing.assert_allclose(handle.position(), there[:3, 3], atol=0.003)
        handle.reset(here)


@pytest.mark.parametrize("yaw", [0.0, 0.26, 1.3, -2.6])
def test_fingers_of_a_level_hand_turn_with_it(world: SoftWorld, yaw: float) -> None:
    approach = np.array((np.cos(yaw), np.sin(yaw), 0.0))  # level: the x axis of the hand is upright
    across = np.cross(approach, (0.0, 0.0, 1.0))
    turn = np.column_stack([np.cross(across, approach), across, approach])
    pose = np.eye(4)
    pose[:3, :3] = turn
    handle = Handle(world.client, pose, opening=0.05)
    shapes = world.client.getCollisionShapeData(handle.body, handle.link)
    assert len(shapes) == 3
    for shape in shapes:
        assert np.reshape(world.client.getMatrixFromQuaternion(shape[6]), (3, 3)) == pytest.approx(turn, abs=1e-5)


def test_angles_of_any_rotation_turn_back_to_it(world: SoftWorld) -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        turn *= np.sign(np.linalg.det(turn))
        quaternion = world.client.getQuaternionFromEuler(roll_pitch_yaw(turn))
        assert np.reshape(world.client.getMatrixFromQuaternion(quaternion), (3, 3)) == pytest.approx(turn, abs=1e-6)
