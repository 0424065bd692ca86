"""PyBullet's physics servers, without the lines it prints when it is loaded and when a server starts."""

from __future__ import annotations

import contextlib
import ctypes
import os
from collections.abc import Iterator
from typing import Any

__all__ = ["direct_client", "pybullet", "silence"]


@contextlib.contextmanager
def silence() -> Iterator[None]:
    """Drop what compiled code writes to stdout and stderr meanwhile; Python's own output is not asked to wait.

    Where a process has no such descriptors (a service without a terminal), there is nothing to drop.
    """
    try:
        kept = [(target, os.dup(target)) for target in (1, 2)]
    except OSError:
        yield
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    _flush()
    try:
        for target, _ in kept:
            os.dup2(nowhere, target)
        yield
    finally:
        _flush()
        os.close(nowhere)
        for target, copy in kept:
            os.dup2(copy, target)
            os.close(copy)


def _flush() -> None:
    """Write what compiled code holds back: into a pipe it would come out only at the end."""
    with contextlib.suppress(OSError, AttributeError, TypeError):  # Windows keeps no library of the program's own
        ctypes.CDLL(None).fflush(None)


with silence():
    import pybullet
    from pybullet_utils.bullet_client import BulletClient


class _Client(BulletClient):
    """Keeps each function of its server once it has been made: PyBullet's own client makes it anew for every call."""

    def __getattr__(self, name: str) -> Any:
        value = super().__getattr__(name)
        if name != "disconnect":  # to ask for that one marks the client as closed
            vars(self)[name] = value
        return value


def direct_client() -> Any:
    """A new physics server in this process, without a window."""
    with silence():
        return _Client(pybullet.DIRECT)
