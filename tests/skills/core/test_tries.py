from collections.abc import Generator

import pytest
from caretree.skills.core.tries import Tries


def first_even(numbers):
    tries = Tries(ValueError)
    for number in numbers:
        with tries:
            if number % 2:
                raise ValueError(f"{number} is odd")
            return number
    raise tries.last


def test_the_first_candidate_that_will_do_ends_the_search():
    assert first_even([3, 5, 4, 7, 2]) == 4


def test_where_none_will_do_the_last_problem_is_told_and_the_first_is_known():
    with pytest.raises(ValueError, match="5 is odd"):
        first_even([3, 7, 5])
    tries = Tries(ValueError, KeyError)
    for problem in (KeyError("a"), ValueError("b")):
        with tries:
            raise problem
    assert (str(tries.first), str(tries.last)) == ("'a'", "b")
    assert len(tries.problems) == 2


def test_other_exceptions_pass():
    tries = Tries(ValueError)
    with pytest.raises(ZeroDivisionError), tries:
        raise ZeroDivisionError
    assert tries.problems == []


def test_without_a_candidate_there_is_no_problem_to_tell():
    with pytest.raises(RuntimeError, match="no candidate"):
        first_even([])


def moves(candidates, log) -> Generator[None, None, str]:
    tries = Tries(ValueError)
    for candidate in candidates:
        with tries:
            yield from move(candidate, log)
            return candidate
    raise tries.last


def move(candidate, log):
    try:
        yield
        if candidate == "blocked":
            raise ValueError(candidate)
        yield
    finally:
        log.append(candidate)


def test_candidates_may_take_several_ticks():
    log = []
    ticks = list(moves(["blocked", "free", "other"], log))
    assert len(ticks) == 3
    assert log == ["blocked", "free"]


def test_a_generator_that_is_closed_inside_tries_nothing_more():
    log = []
    motion = moves(["free", "other"], log)
    next(motion)
    motion.close()
    assert log == ["free"]
