"""Clocks that are slow, late, dead or blocking, and the one who waits for them."""

import pytest
from caretree.sim.waiting import PATIENCE, TRIES, wait
from caretree.sim.world import WorldError


class Clock:
    """Gains `step` [s] in each wait, which takes `wall` [s]."""

    def __init__(self, step, wall=0.0):
        self.time, self.wall, self.waits = 0.0, 0.0, 0
        self.step, self.takes = step, wall

    def now(self):
        return self.time

    def wait_until(self, time):
        self.waits += 1
        self.wall += self.takes
        self.time = min(self.time + self.step, time)


def waited(clock, until):
    wait(clock, until, wall=lambda: clock.wall)
    return clock


def test_a_clock_that_comes_back_early_is_asked_again():
    clock = waited(Clock(step=0.03), 0.1)
    assert (clock.time, clock.waits) == (0.1, 4)


def test_a_time_that_is_over_is_not_waited_for():
    assert waited(Clock(step=0.0), 0.0).waits == 0


def test_the_rounding_of_steps_is_not_waited_for():
    class Short(Clock):
        def wait_until(self, time):
            super().wait_until(time - 1e-9)

    assert waited(Short(step=1.0), 0.5).waits == 1


def test_a_clock_that_stands_still_is_dead_after_some_tries():
    clock = Clock(step=0.0)
    with pytest.raises(WorldError, match="the world's clock stands still"):
        waited(clock, 1.0)
    assert clock.waits == TRIES


def test_a_wait_that_blocks_is_not_tried_for_minutes():
    clock = Clock(step=0.0, wall=5.0)
    with pytest.raises(WorldError, match="stands still"):
        waited(clock, 1.0)
    assert clock.waits == 1


def test_a_slow_clock_is_not_dead_as_long_as_it_goes():
    clock = waited(Clock(step=0.01, wall=0.9 * PATIENCE), 0.1)
    assert clock.time == pytest.approx(0.1)
