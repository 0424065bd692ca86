"""Motions of both hands that pass at the same time."""

from __future__ import annotations

from collections.abc import Iterator


def together(*motions: Iterator[None]) -> Iterator[None]:
    """One step of each motion in every tick, until the last one ends.

    Args:
        motions: generators of skills, each of which commands something of its own.
    """
    going = list(motions)
    while going:
        for motion in tuple(going):
            try:
                next(motion)
            except StopIteration:
                going.remove(motion)
        if going:
            yield
