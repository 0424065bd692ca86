"""Loops compiled by numba, kept on disk where there is a place for them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba
from numba import types
from numba.extending import intrinsic


def njit(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Like `numba.njit(cache=True, **options)`.

    Where neither the package's folder nor the user's cache can be written, every process compiles anew, which takes
    seconds, instead of none starting.
    """

    def compiled(function: Callable[..., Any]) -> Any:
        try:
            return numba.njit(cache=True, **options)(function)
        except RuntimeError as error:
            if "cannot cache" not in str(error):
                raise
            return numba.njit(**options)(function)

    return compiled


def _fma(typing_context: Any, a: Any, b: Any, c: Any) -> Any:
    """The sum a * b + c rounded once, for compiled loops: so BLAS adds up, whose results they give to the last bit."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), generate


fma: Any = intrinsic(_fma)
