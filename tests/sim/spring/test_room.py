"""The room of springs beside PyBullet's: what is held, felt and pushed in it."""

import numpy as np
import pytest
from caretree.sim.bullet.cloth import UnstableClothError
from caretree.sim.bullet.handle import Handle
from caretree.sim.bullet.soft_world import GRAVITY
from caretree.sim.bullet.units import ROOM
from caretree.sim.scene.gown import GOWNS, build_gown
from caretree.sim.scene.objects import Sheet as Towel
from caretree.sim.scene.objects import sheet_mesh
from caretree.sim.spring.room import SpringCloth, SpringRoom

from .conftest import DT, block


def test_a_hand_that_holds_a_gown_feels_its_weight_and_takes_it_along(room):
    mesh = build_gown(GOWNS["medium"])
    cloth = SpringCloth(room, mesh, mesh.vertices + (0.0, 0.0, 1.6))
    pose = np.eye(4)
    pose[:3, 3] = cloth.vertices()[mesh.collar[7]]
    handle = Handle(room.client, pose)
    near = np.argsort(np.linalg.norm(cloth.vertices() - pose[:3, 3], axis=1))[:4]
    cloth.pin(near, handle.body, handle.link)
    before, loads = cloth.vertices()[near], []
    for k in range(5600):
        if k < 800:
            pose[0, 3] += 0.1 * DT
        handle.follow(pose)
        room.step()
        if k >= 4800:
            loads.append(cloth.load(near, cloth.vertices()))
    assert np.mean(loads, axis=0)[2] == pytest.approx(-mesh.spec.mass * GRAVITY, rel=0.02)
    np.testing.assert_allclose(cloth.vertices()[near] - before, [(0.2, 0, 0)] * 4, atol=0.003)


def test_what_two_hold_stays_when_one_lets_go(room, towel):
    cloth = SpringCloth(room, towel, towel.vertices + (0, 0, 1))
    one, other = cloth.pin([0, 1]), cloth.pin([1, 2])
    cloth.unpin(one)
    assert cloth.sheet.held == {1, 2}
    before = cloth.vertices()
    for _ in range(40):
        room.step()
    now = cloth.vertices()
    np.testing.assert_array_equal(now[[1, 2]], before[[1, 2]])
    assert now[0, 2] < before[0, 2] - 1e-3
    cloth.unpin(other)
    assert not cloth.sheet.held


def test_a_cloth_that_was_taken_away_is_nowhere(room, towel):
    cloth = SpringCloth(room, towel, towel.vertices)
    cloth.remove()
    assert cloth.body < 0
    assert cloth.vertices().shape == (0, 3)
    room.step()


def test_cloths_have_numbers_of_their_own(room, towel):
    first = SpringCloth(room, towel, towel.vertices)
    first.remove()
    second, third = (SpringCloth(room, towel, towel.vertices) for _ in range(2))
    assert len({second.body, third.body}) == 2


def test_momentum_goes_from_cloth_to_what_it_hits(room):
    mesh = sheet_mesh(Towel(name="towel", size=(0.4, 0.4), position_in_map=(0.0, 0.0, 1.0)))
    room.client.setGravity(0, 0, 0)
    body = block(room.client, (0.3, 0.3, 0.1), (0, 0, 0), mass=1.0)
    cloth = SpringCloth(room, mesh, mesh.vertices + (0, 0, 0.08))
    cloth.sheet.gravity = np.zeros(3)
    cloth.sheet.v[:] = (0, 0, -0.5)
    for _ in range(400):
        room.step()
    speed = np.array(room.client.getBaseVelocity(body)[0])[2] * ROOM.per_second
    mine = mesh.spec.mass * cloth.sheet.v.mean(axis=0)[2]
    assert speed < -0.03
    assert speed * 1.0 + mine == pytest.approx(mesh.spec.mass * -0.5, rel=0.02)


def test_an_unstable_gown_is_refused(towel):
    room = SpringRoom(0.02)
    with pytest.raises(UnstableClothError, match=r"at most 0\.7 is stable"):
        SpringCloth(room, towel, towel.vertices)
    room.close()
