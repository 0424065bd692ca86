"""The hook on the rail: holds the gown by its neckline until a hand takes the weight off it."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np

from .cloth import ClothBody
from .handle import Handle

FREE_LOAD = 0.5  # a loop of cloth that pulls down less than this slips off an open hook [N]
NEAR = 0.05  # cloth of which the hung part is as near as this hangs on it [m]
FREE_TIME = 0.10  # ... after this long [s]


class Hook:
    """An open hook.  What hangs on it is pinned; when it no longer pulls down, it comes off."""

    def __init__(self, client: Any, cloth: ClothBody, position: np.ndarray, vertex: int) -> None:
        pose = np.eye(4)
        pose[:3, 3] = position
        self.cloth = cloth
        self.handle = Handle(client, pose)
        self._pose = pose
        vertices = cloth.vertices()
        near = np.argsort(np.linalg.norm(vertices - vertices[vertex], axis=1))[:3]
        self._held = [int(k) for k in near]
        self._pins = cloth.pin(near, self.handle.body, self.handle.link)
        self._light = 0.0

    @property
    def holds(self) -> bool:
        """Whether the gown hangs on it."""
        return bool(self._pins)

    def load(self, vertices: np.ndarray) -> np.ndarray:
        """(3,) force of the cloth, whose vertices are given, on the hook [N]."""
        return self.cloth.load(self._held, vertices) if self.holds else np.zeros(3)

    def carries(self, vertices: np.ndarray) -> bool:
        """Whether the cloth, its vertices (V, 3) being there, still hangs where it was hung up."""
        return self.holds and float(np.linalg.norm(vertices[self._held].mean(axis=0) - self._pose[:3, 3])) < NEAR

    def before_step(self) -> None:
        """Keep still."""
        if self.holds:
            self.handle.follow(self._pose)

    def watch(self, duration: float, taken: Collection[int], vertices: np.ndarray) -> None:
        """Let go of what a hand has `taken`, and of all of it once nothing has pulled down for a while.

        What is pinned here and in a hand tears between the two, and its load is felt by neither (146).

        Args:
            duration: since the last time [s].
            taken: vertices of the cloth that hands hold.
            vertices: (V, 3) where they are [m].
        """
        if not self.holds:
            return
        self._give(taken)
        self._light = self._light + duration if taken and -self.load(vertices)[2] < FREE_LOAD else 0.0
        if self._light > FREE_TIME:
            self.release()

    def release(self) -> None:
        """Take the gown off."""
        self.cloth.unpin(self._pins)
        self._pins = []

    def _give(self, taken: Collection[int]) -> None:
        """Unpin the vertices that hands hold by now."""
        both = [(k, pin) for k, pin in zip(self._held, self._pins, strict=True) if k in taken]
        self.cloth.unpin(pin for _, pin in both)
        for vertex, pin in both:
            self._held.remove(vertex)
            self._pins.remove(pin)
