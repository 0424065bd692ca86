"""Errors of those who watch do not reach whoever shows them something."""

import errno

import pytest
from caretree.sim.errors import RecordError
from caretree.sim.fence import fenced, said


def test_errors_are_told_once_and_what_still_works_goes_on():
    shown, told = [], []

    def watch(what, *, fails):
        shown.append(what)
        if fails:
            raise ValueError(what)

    watched = fenced(watch, told.append)
    for what, fails in (("a", False), ("b", True), ("c", True), ("d", False)):
        assert watched(what, fails=fails) is None
    assert shown == ["a", "b", "c", "d"]
    assert [str(error) for error in told] == ["b"]


def test_the_operators_word_is_no_error():
    def watch():
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fenced(watch, print)()


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (OSError(errno.ENOSPC, "No space left on device", "a.txt"), "No space left on device"),
        (RecordError("the disk is full"), "the disk is full"),
        (ZeroDivisionError(), "ZeroDivisionError"),
    ],
)
def test_an_error_is_said_in_one_clause(error, sentence):
    assert said(error) == sentence
