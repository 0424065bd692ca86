"""Loops compiled by numba, kept on disk where there is a place for them; without numba they run as plain Python."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any


def _numba() -> Any:
    """The package, or None: the core does without it, and its loops are then some hundred times slower."""
    try:
        importlib.import_module("numba.extending")
        return importlib.import_module("numba")
    except ModuleNotFoundError as error:
        if error.name != "numba":
            raise
        return None


numba = _numba()


def njit(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Like `numba.njit(cache=True, **options)`.

    Where neither the package's folder nor the user's cache can be written, every process compiles anew, which takes
    seconds, instead of none starting.
    """

    def compiled(function: Callable[..., Any]) -> Any:
        if numba is None:
            return function
        try:
            return numba.njit(cache=True, **options)(function)
        except RuntimeError as error:
            if "cannot cache" not in str(error):
                raise
            return numba.njit(**options)(function)

    return compiled


@njit()
def _itself(value: float) -> float:
    return value


def load() -> None:
    """Have numba load now what it loads at the first call of any loop: 0.4 s on a busy machine, else within a tick."""
    _itself(0.0)


def _fma(typing_context: Any, a: Any, b: Any, c: Any) -> Any:
    """The sum a * b + c rounded once, for compiled loops: so BLAS adds up, whose results they give to the last bit."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fma(*arguments)

    number = numba.types.float64
    return number(number, number, number), generate


def _rounded_twice(a: float, b: float, c: float) -> float:
    """The sum a * b + c, where nothing is compiled that could round it once."""
    return a * b + c


fma: Any = _rounded_twice if numba is None else numba.extending.intrinsic(_fma)
