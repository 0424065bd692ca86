"""Compiled loops work where nothing can be written too."""

from fractions import Fraction

import numba
import numpy as np
import pytest
from caretree.sim import compiled
from caretree.sim.compiled import fma, njit


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


def test_sums_in_compiled_loops_are_rounded_once_a_term():
    add = njit()(lambda a, b: fma(a[2], b[2], fma(a[1], b[1], a[0] * b[0])))
    pairs = np.random.default_rng(0).normal(size=(200, 2, 3))
    exact = [sum(Fraction(x) * Fraction(y) for x, y in zip(a, b, strict=True)) for a, b in pairs.tolist()]
    assert [add(a, b) for a, b in pairs] == pytest.approx([float(each) for each in exact], abs=1e-15)
    tiny = 2.0**-60
    assert njit()(lambda x: fma(x, x, -1.0))(1.0 + 2.0**-30) == 2.0**-29 + tiny  # rounded once: the last bit stays


def test_what_a_first_call_loads_can_be_loaded_before(monkeypatch):
    fresh = njit()(lambda value: value)
    monkeypatch.setattr(compiled, "_itself", fresh)
    compiled.load()
    assert len(fresh.signatures) == 1
