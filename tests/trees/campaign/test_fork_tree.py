"""Processes that fork from each other: what they report, who waits for whom, and what ends them."""

import os
import signal

import pytest
from caretree.trees.campaign.fork_tree import ForkTree

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system cannot fork")


@pytest.fixture
def pipe():
    ends = os.pipe()
    yield ends
    for end in ends:
        os.close(end)


def test_every_process_reports_to_the_first_and_with_one_slot_a_fork_is_done_first():
    tree = ForkTree()

    def work():
        if tree.fork():
            tree.report("inner" if tree.fork() else "outer")
        else:
            tree.report("last")

    assert list(tree.reports(work)) == ["inner", "outer", "last"]


def test_with_two_slots_two_are_at_work_at_once(pipe):
    tree = ForkTree(jobs=2)

    def work():
        if tree.fork():
            tree.report(os.read(pipe[0], 1).decode())  # what the other one writes after the fork
        else:
            os.write(pipe[1], b"x")

    assert list(tree.reports(work)) == ["x"]


def test_one_that_lent_its_slot_goes_on_when_another_is_free(pipe):
    tree = ForkTree(jobs=2)

    def work():
        if tree.fork():  # with a slot of its own
            tree.report("first " + os.read(pipe[0], 1).decode())
        elif tree.fork():  # with the parent's
            os.write(pipe[1], b"a")
            tree.report("second " + os.read(pipe[0], 1).decode())
        else:
            os.write(pipe[1], b"b")

    assert sorted(report[:-2] for report in tree.reports(work)) == ["first", "second"]


def test_one_that_is_killed_or_fails_loses_its_own_reports_only(capfd):
    tree = ForkTree(jobs=2)

    def work():
        if tree.fork():
            os.write(tree._writing, b"half of a li")
            os.kill(os.getpid(), signal.SIGKILL)
        if tree.fork():
            raise RuntimeError("planted")
        tree.report("whole")
        if tree.fork():
            tree.report("later")

    assert {"whole", "later"} <= set(tree.reports(work))
    assert "RuntimeError: planted" in capfd.readouterr().err


def test_whoever_asks_for_no_more_ends_them_all(pipe):
    tree = ForkTree()

    def work():
        tree.report(str(os.getpid()))
        os.read(pipe[0], 1)

    reports = tree.reports(work)
    first = int(next(reports))
    reports.close()
    with pytest.raises(ProcessLookupError):
        os.kill(first, 0)


def test_they_end_when_whoever_began_is_killed():
    """They hold the only other ends of a pipe, which ends with the last of them."""
    alive, held = os.pipe()
    campaign = os.fork()
    if campaign == 0:
        tree = ForkTree(jobs=2)

        def work():
            tree.report("begun")
            while True:
                tree.fork()

        next(tree.reports(work))
        os.kill(os.getpid(), signal.SIGKILL)
    os.close(held)
    os.waitpid(campaign, 0)
    assert os.read(alive, 1) == b""
    os.close(alive)
