"""A child of a campaign ends, gently first, when its campaign is gone."""

import os
import signal

from caretree.trees.campaign import child


def test_the_child_is_ended_when_another_is_its_parent(monkeypatch):
    done = []
    monkeypatch.setattr(child.os, "kill", lambda process, number: done.append((process, number)))
    monkeypatch.setattr(child.time, "sleep", done.append)
    parents = iter([7, 7, 1])
    monkeypatch.setattr(child.os, "getppid", lambda: next(parents))
    child.watch(7)
    me = os.getpid()
    assert done == [child.LOOKS, child.LOOKS, (me, signal.SIGTERM), child.ENDING, (me, signal.SIGKILL)]


def test_the_command_line_is_run_under_that_watch(monkeypatch):
    watched = []
    monkeypatch.setattr(child, "watch", watched.append)
    monkeypatch.setattr(child, "main", lambda: 3)
    assert child.run_watched(7) == 3
    assert watched == [7]
