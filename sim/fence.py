"""A fence around whoever only watches a run: recorder, live view, terminal.

A robot that holds a person's arm must not stand still because nobody can watch it any more.  So errors of those who
watch are kept from whoever shows them something, and told instead, to be acted on between two ticks.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import ParamSpec

P = ParamSpec("P")


def fenced(watch: Callable[P, object], on_error: Callable[[Exception], None]) -> Callable[P, None]:
    """`watch`, whose errors do not reach the caller.

    Args:
        watch: is shown something; called again after an error, as some of what it does may still work.
        on_error: told of the first error; the others follow from it.
    """
    told = False

    def call(*args: P.args, **kwargs: P.kwargs) -> None:
        nonlocal told
        try:
            watch(*args, **kwargs)
        except Exception as error:
            if not told:
                told = True
                on_error(error)

    return call


def said(error: Exception) -> str:
    """One clause for an error."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return str(error) or type(error).__name__
