"""What lies still sleeps: its engine is not asked where it is, until something wakes it."""

import numpy as np
import pytest
from caretree.sim.bullet.sleep import SLEEP_MOVE, SLEEP_TIME, Sleep

STEP = 0.0025  # [s]
ROUND = int(SLEEP_TIME / STEP)  # steps between two looks


class Lying:
    """Cloth, arms and objects that are moved by hand."""

    def __init__(self):
        self.cloth, self.bones, self.apart, self.asked = np.zeros((3, 3)), np.zeros((2, 4, 3)), 0.0, 0

    def vertices(self):
        self.asked += 1
        return self.cloth.copy()

    def arms(self):
        return self.bones.copy()

    def moved(self):
        return self.apart


@pytest.fixture
def lying():
    return Lying()


@pytest.fixture
def sleep(lying):
    return Sleep(lying, lying, lying, STEP)


def test_what_has_not_moved_between_two_looks_sleeps(lying, sleep):
    assert [step for step in range(1, 3 * ROUND) if sleep.due(step)] == [ROUND, 2 * ROUND]
    lying.cloth += 2 * SLEEP_MOVE
    sleep.look(ROUND, busy=False)
    assert not sleep.asleep
    sleep.look(2 * ROUND, busy=False)
    assert sleep.asleep
    assert not sleep.due(3 * ROUND)
    sleep.wake()
    assert sleep.due(3 * ROUND)


@pytest.mark.parametrize("what", ["cloth", "arms", "objects", "busy"])
def test_anything_that_moves_keeps_all_awake(lying, sleep, what):
    lying.cloth[1] += 2 * SLEEP_MOVE * (what == "cloth")
    lying.bones[1, 2] += 2 * SLEEP_MOVE * (what == "arms")
    lying.apart = 2 * SLEEP_MOVE * (what == "objects")
    sleep.look(ROUND, busy=what == "busy")
    assert not sleep.asleep


def test_nothing_sleeps_before_the_first_step(sleep):
    sleep.look(0, busy=False)
    assert not sleep.asleep


def test_the_engine_is_asked_once_between_two_steps_and_not_at_all_in_sleep(lying, sleep):
    lying.asked = 0
    first = sleep.vertices_at(7)
    assert sleep.vertices_at(7) is first
    assert lying.asked == 1
    sleep.vertices_at(8)
    assert lying.asked == 2
    sleep.look(ROUND, busy=False)
    lying.asked = 0
    sleep.vertices_at(ROUND + 1)
    assert lying.asked == 0
    sleep.look_anew()
    assert lying.asked == 1
