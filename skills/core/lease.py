"""The motion lease: one skill at a time may command, and it keeps the lease until its motion has stopped.

Stopping takes several ticks, so a skill that was preempted, failed or ended early hands its `cancel` to the
lease; whoever ticks the tree also calls `advance` once per tick until nothing is left to release.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol


class Owner(Protocol):
    """Who can hold the lease."""

    name: str


class MotionLease:
    """Grants motion to one owner at a time.

    Args:
        patience: how long a release may take before it counts as stuck [s].
        now: the world's clock.
    """

    def __init__(self, now: Callable[[], float], patience: float = 5.0) -> None:
        self.holder: Owner | None = None
        self.patience = patience
        self._now = now
        self._releasing: dict[int, tuple[Owner, Callable[[], bool], float]] = {}

    def acquire(self, owner: Owner) -> bool:
        """Take the lease if it is free; True when `owner` holds it and is not still stopping an earlier motion."""
        if id(owner) in self._releasing:
            return False
        if self.holder is None:
            self.holder = owner
        return self.holder is owner

    def release(self, owner: Owner) -> None:
        """Give the lease back at once; nothing happens when `owner` does not hold it."""
        self._releasing.pop(id(owner), None)
        if self.holder is owner:
            self.holder = None

    def release_when(self, owner: Owner, stopped: Callable[[], bool]) -> None:
        """Give the lease back when `stopped` first returns True; asked once per `advance`."""
        if id(owner) not in self._releasing:
            self._releasing[id(owner)] = (owner, stopped, self._now())

    def releasing(self, owner: Owner | None = None) -> bool:
        """Whether `owner` (or anybody) is still stopping."""
        return bool(self._releasing) if owner is None else id(owner) in self._releasing

    def stuck(self) -> Owner | None:
        """An owner that has been stopping for longer than `patience`, if there is one."""
        now = self._now()
        return next((owner for owner, _, since in self._releasing.values() if now - since > self.patience), None)

    def advance(self) -> None:
        """Carry every release one tick further."""
        for owner, stopped, _ in list(self._releasing.values()):
            if stopped():
                self.release(owner)

    def clear(self) -> None:
        """Forget every holder: only when the world itself has been stopped."""
        self.holder = None
        self._releasing.clear()
