"""Time that passes only when somebody waits for it."""

from caretree.sim.scripted.clock import SteppedClock


def test_waiting_lets_the_world_advance_to_that_time():
    asked = []

    def advance(time):
        asked.append(time)
        clock.time = time

    clock = SteppedClock(advance)
    assert clock.now() == 0.0
    clock.wait_until(1.5)  # [s]
    assert (asked, clock.now()) == ([1.5], 1.5)
    assert clock.now() == 1.5  # and asking alone lets none pass
