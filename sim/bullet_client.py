"""PyBullet's physics servers, without the lines it prints when it is loaded and when a server starts."""

from __future__ import annotations

import contextlib
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
    try:
        for target, _ in kept:
            os.dup2(nowhere, target)
        yield
    finally:
        os.close(nowhere)
        for target, copy in kept:
            os.dup2(copy, target)
            os.close(copy)


with silence():
    import pybullet
    from pybullet_utils.bullet_client import BulletClient


def direct_client() -> Any:
    """A new physics server in this process, without a window."""
    with silence():
        return BulletClient(pybullet.DIRECT)
