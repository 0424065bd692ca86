"""What hangs on the hook: it comes off when nothing pulls down, and a hand that takes part of it takes that off."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.sim.bullet.cloth import ClothBody
from caretree.sim.bullet.hook import FREE_LOAD, FREE_TIME, Hook
from caretree.sim.bullet_client import direct_client

STEP = 0.02  # between two looks at the load [s]
ROW = np.array([(0.03 * k, 0.0, 1.5) for k in range(6)])  # six vertices, of which the first three are hung up [m]


class Row(ClothBody):
    """A row of vertices that knows who is pinned, and pulls down with what it is told."""

    def __init__(self, client: object, down: float) -> None:
        self.client, self.down, self.pinned, self.asked = client, down, {}, []

    def vertices(self) -> np.ndarray:
        return ROW

    def pin(self, ids, body=-1, link=-1):
        numbers = [100 + int(k) for k in ids]
        self.pinned |= {number: number - 100 for number in numbers}
        return numbers

    def unpin(self, constraints):
        for number in constraints:
            del self.pinned[number]

    def load(self, held, vertices):
        self.asked = sorted(held)
        return np.array((0.0, 0.0, -self.down))

    def place(self, vertices):
        raise NotImplementedError

    def remove(self):
        raise NotImplementedError


@pytest.fixture
def client():
    client = direct_client()
    yield client
    client.disconnect()


def hung(client: object, down: float = 4.0) -> tuple[Row, Hook]:
    cloth = Row(client, down)
    return cloth, Hook(client, cloth, ROW[0], 0)


def test_it_keeps_what_pulls_down(client):
    cloth, hook = hung(client, down=2 * FREE_LOAD)
    for _ in range(50):
        hook.watch(STEP, {5}, ROW)
    assert hook.holds
    assert sorted(cloth.pinned.values()) == [0, 1, 2]


def test_it_lets_go_of_what_a_hand_carries(client):
    cloth, hook = hung(client, down=0.5 * FREE_LOAD)
    for _ in range(int(FREE_TIME / STEP)):
        hook.watch(STEP, {5}, ROW)
    assert hook.holds  # not yet
    for _ in range(2):
        hook.watch(STEP, {5}, ROW)
    assert not hook.holds
    assert not cloth.pinned


def test_what_nobody_holds_stays_however_light_it_is(client):
    _, hook = hung(client, down=0.0)
    for _ in range(50):
        hook.watch(STEP, set(), ROW)
    assert hook.holds


def test_vertices_that_a_hand_takes_are_no_longer_pinned_here_nor_felt(client):
    cloth, hook = hung(client)
    hook.watch(STEP, {1, 4}, ROW)
    assert sorted(cloth.pinned.values()) == [0, 2]
    hook.load(ROW)
    assert cloth.asked == [0, 2]
    assert hook.holds


def test_a_hand_that_takes_all_that_hangs_there_has_taken_it_off(client):
    cloth, hook = hung(client)
    hook.watch(STEP, {0, 1, 2, 3}, ROW)
    assert not hook.holds
    assert not cloth.pinned
    assert not hook.carries(ROW)
