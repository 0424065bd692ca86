"""The hook on the rail: holds the gown by its neckline until a hand takes the weight off it."""

from __future__ import annotations

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
        away = np.linalg.norm(vertices[self._held].mean(axis=0) - self._pose[:3, 3])
        return self.holds and float(away) < NEAR

    def before_step(self) -> None:
        """Keep still."""
        if self.holds:
            self.handle.follow(self._pose)

    def watch(self, duration: float, taken: bool, vertices: np.ndarray) -> None:
        """Let go when a hand holds the gown (`taken`) and nothing has pulled down for a while; every `duration` [s]."""
        if not self.holds:
            return
        self._light = self._light + duration if taken and -self.load(vertices)[2] < FREE_LOAD else 0.0
        if self._light > FREE_TIME:
            self.release()

    def release(self) -> None:
        """Take the gown off."""
        self.cloth.unpin(self._pins)
        self._pins = []
