"""The balance against a known weight: a gown that lies on the person weighs on it."""

from __future__ import annotations

import numpy as np
import pybullet
import pytest
from caretree.sim.bullet.person import Person
from caretree.sim.bullet.person_force import ForceBalance, count_touching
from caretree.sim.bullet.soft_world import GRAVITY
from caretree.sim.scene.person_spec import PERSON_PARTS, PERSONS
from pybullet_utils.bullet_client import BulletClient


@pytest.fixture(scope="module")
def person():
    """The person alone."""
    client = BulletClient(pybullet.DIRECT)
    client.setGravity(0, 0, -GRAVITY)
    yield Person(client, PERSONS["average"], 0.6)
    client.disconnect()


def on_chest(n: int = 200) -> np.ndarray:
    x, y = np.meshgrid(np.linspace(-0.05, 0.05, 10), np.linspace(-0.4, -0.1, n // 10))
    return np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.825)], axis=1)


def test_cloth_at_rest_on_the_chest_weighs_on_the_trunk(person):
    balance = ForceBalance(person, 0.45, 0.6)
    for t in (0.0, 0.08, 0.16):
        force = balance.parts(t, on_chest(), np.zeros(3), {})
    assert force[PERSON_PARTS.index("trunk")] == pytest.approx(0.45 * GRAVITY, rel=0.01)
    assert force[1:].max() == 0.0


def test_what_a_hand_carries_does_not_weigh_on_the_person(person):
    balance = ForceBalance(person, 0.45, 0.6)
    for t in (0.0, 0.08, 0.16):
        force = balance.parts(t, on_chest(), np.array((0.0, 0.0, 0.45 * GRAVITY)), {})
    assert force.max() < 0.01


def test_free_fall_presses_on_nobody(person):
    balance = ForceBalance(person, 0.45, 0.6)
    for t in (0.0, 0.02, 0.04):
        force = balance.parts(t, on_chest() - (0.0, 0.0, 0.5 * GRAVITY * t**2), np.zeros(3), {})
    assert force.max() < 0.02


def test_a_held_arm_feels_the_hand(person):
    balance = ForceBalance(person, 0.45, 0.6)
    part = PERSON_PARTS.index("right_upper_arm")
    carried = np.array((0.0, 0.0, 0.45 * GRAVITY))
    force = balance.parts(0.0, on_chest() + (0, 0, 2.0), carried, {part: np.array((0.0, 0.0, 12.0))})
    assert force[part] == pytest.approx(12.0)


def gap(points, a, b):
    d = b - a
    f = np.clip((points - a) @ d / (d @ d), 0.0, 1.0)
    return np.linalg.norm(points - (a + f[:, None] * d), axis=1)


def test_vertices_that_touch_are_counted_as_by_numpy():
    rng = np.random.default_rng(4)
    points, ends, reach = rng.uniform(-1, 1, (2000, 3)), rng.uniform(-1, 1, (12, 2, 3)), rng.uniform(0.02, 0.5, 12)
    expected = [(gap(points, a, b) < most).sum() for (a, b), most in zip(ends, reach, strict=True)]
    np.testing.assert_array_equal(count_touching(points, ends, reach), expected)
    assert min(expected) > 0
