"""Work beside the run: in order, with errors told, and never more of it than there is room for."""

from __future__ import annotations

import threading

import pytest
from caretree.sim.record.background import WAITING_MAX, Background


def test_work_is_done_in_order():
    done = []
    background = Background()
    for k in range(20):
        assert background.give(lambda k=k: done.append(k), wait=True)
    background.close()
    background.close()
    assert done == list(range(20))


def test_work_is_turned_down_when_too_much_waits():
    gate, begun = threading.Event(), threading.Event()
    background = Background()
    background.give(lambda: (begun.set(), gate.wait()), wait=True)
    begun.wait()
    taken = [background.give(lambda: None, wait=False) for _ in range(WAITING_MAX + 2)]
    assert taken == [True] * WAITING_MAX + [False] * 2
    gate.set()
    background.close()


def test_an_error_is_told_once_and_ends_the_work():
    done = []
    background = Background()
    background.give(lambda: 1 / 0, wait=True)
    background.give(lambda: done.append(1), wait=True)
    with pytest.raises(ZeroDivisionError):
        background.close()
    background.close()
    assert done == []
