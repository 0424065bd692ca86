"""The gown of a run: its cloth, the hook that it hangs on at first, and the effects of a model file that act on it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..effects.cloth.proxy_bodies import ClothPatch
from ..effects.model_file import EffectModel
from ..scene.scene import RAIL_HEIGHT, Scene
from .cloth import ClothBody, load_gown
from .engines import ClothEngine
from .grip import Grip
from .hook import Hook


class Gown:
    """Cloth that hangs, is held, lies, or was taken away.

    Args:
        engine: what moves it.
        soft: the room that it is loaded into.
        scene: what was drawn.
        effects: that act on it, if any.
        trunk: (n, 7) capsules of the person, for effects that need them [m].

    Attributes:
        cloth: the body.
        hook: that it hangs on, once it was hung up.
    """

    hook: Hook

    def __init__(
        self, engine: ClothEngine, soft: Any, scene: Scene, effects: EffectModel | None, trunk: np.ndarray
    ) -> None:
        turn = np.array(
            (
                (math.cos(scene.hang_yaw), -math.sin(scene.hang_yaw), 0.0),
                (math.sin(scene.hang_yaw), math.cos(scene.hang_yaw), 0.0),
                (0.0, 0.0, 1.0),
            )
        )
        hung = scene.mesh.vertices @ turn.T
        self._hook_at, self._hung_by = np.array((*scene.rail_xy, RAIL_HEIGHT)), scene.hang_vertex
        start = hung - hung[scene.hang_vertex] + self._hook_at
        self.cloth: ClothBody
        self._patch: ClothPatch | None = None
        if effects is None:
            self.cloth = engine.cloth(soft, scene.mesh, start)
        else:
            self.cloth, self._patch = load_gown(
                soft, scene.mesh, start, effects, pinned={scene.hang_vertex}, capsules=trunk
            )

    @property
    def gone(self) -> bool:
        """Whether it was taken away."""
        return self.cloth.body < 0

    def hang_up(self, client: Any) -> None:
        """Hang it on its hook; after the bodies around it, whose order decides how the engine's solver goes."""
        self.hook = Hook(client, self.cloth, self._hook_at, self._hung_by)

    def take_off_hook(self) -> None:
        """Let it be put elsewhere."""
        self.hook.release()
        if self._patch is not None:  # proxy bodies cannot jump with the cloth
            self._patch.detach()

    def put_down(self, client: Any, vertices: np.ndarray) -> None:
        """Let the effects know where (V, 3) it has been put [m]."""
        if self._patch is not None:
            self._patch.attach(client, self.cloth.body, vertices)

    def remove(self) -> None:
        """Take it out of the room."""
        self.take_off_hook()
        self._patch = None
        self.cloth.remove()

    def apply_effects(self, time: float, grips: Sequence[Grip]) -> None:
        """Let the effects act.

        Args:
            time: world clock [s].
            grips: of both hands, from one of which it may slip.
        """
        if self._patch is None:
            return
        self._patch.apply(time)
        if self._patch.release_t is not None and time >= self._patch.release_t:
            holding = [grip for grip in grips if grip.kind == "cloth"]
            if holding:  # it slips once
                holding[0].release()
                self._patch.release_t = None
