"""Time is counted once, for the innermost part."""

import pytest
from caretree.sim import stopwatch
from caretree.sim.stopwatch import Stopwatch, timed


@pytest.fixture
def clock(monkeypatch):
    """A clock whose wall runs twice as fast as its processor: `clock[0]` is the wall time."""
    now = [0.0]
    monkeypatch.setattr(stopwatch.time, "perf_counter", lambda: now[0])
    monkeypatch.setattr(stopwatch.time, "thread_time", lambda: now[0] / 2)
    return now


def test_a_part_inside_another_counts_alone(clock):
    watch = Stopwatch()
    clock[0] += 100.0
    inner = watch.of("inner")
    with watch.of("outer"):
        clock[0] += 1.0
        with inner:
            clock[0] += 4.0
        clock[0] += 2.0
    clock[0] += 100.0
    with inner:  # entered again
        clock[0] += 8.0
    assert dict(watch.wall) == {"outer": 3.0, "inner": 12.0}
    assert dict(watch.processor) == {"outer": 1.5, "inner": 6.0}


def test_an_error_ends_its_part(clock):
    watch = Stopwatch()

    def fails():
        with watch.of("inner"):
            clock[0] += 1.0
            raise ValueError("broken")

    with watch.of("outer"):
        with pytest.raises(ValueError, match="broken"):
            fails()
        clock[0] += 2.0
    assert dict(watch.wall) == {"outer": 2.0, "inner": 1.0}


def test_a_method_is_counted_on_the_stopwatch_of_its_object(clock):
    class Worker:
        def __init__(self):
            self.stopwatch = Stopwatch()

        @timed("work")
        def work(self, seconds, *, more=0.0):
            """Take time."""
            clock[0] += seconds + more
            return "done"

    worker = Worker()
    assert worker.work(1.0, more=2.0) == "done"
    assert worker.work.__doc__ == "Take time."
    assert dict(worker.stopwatch.wall) == {"work": 3.0}
