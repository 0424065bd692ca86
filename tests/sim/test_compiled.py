"""Compiled loops work where nothing can be written too."""

import numba
import pytest
from caretree.sim.compiled import njit


def count(to):
    total = 0
    for k in range(to):
        total += k
    return total


def test_a_loop_is_compiled():
    assert njit()(count)(10) == 45
    assert isinstance(njit(fastmath=True)(count), numba.core.dispatcher.Dispatcher)


def test_without_a_place_for_the_cache_it_is_compiled_without(monkeypatch):
    plain, asked = numba.njit, []

    def full(**options):
        asked.append(options)
        if options.pop("cache", False):
            raise RuntimeError("cannot cache function 'count': no locator available for file 'x.py'")
        return plain(**options)

    monkeypatch.setattr(numba, "njit", full)
    assert njit(fastmath=True)(count)(10) == 45
    assert asked == [{"fastmath": True}, {"fastmath": True}]


def test_another_error_is_not_hidden(monkeypatch):
    def broken(**options):
        raise RuntimeError("out of luck")

    monkeypatch.setattr(numba, "njit", broken)
    with pytest.raises(RuntimeError, match="out of luck"):
        njit()(count)
