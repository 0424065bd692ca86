"""Simulated clips as frames, for methods that simulate what they found."""

from __future__ import annotations

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ...sim.errors import CaretreeError
from ...sim.gown import GownSpec
from .clip_world import film
from .film_camera import FilmCamera
from .frames import frames_of
from .parameters import to_spec


class Simulator:
    """Films gowns of one cut with one camera; a gown that cannot be simulated gets the frames of the last that could.

    Args:
        cut: the gown's cut.
        camera: where it is seen from; the usual one when omitted.
    """

    def __init__(self, cut: GownSpec, camera: FilmCamera | None = None) -> None:
        self.cut, self.camera = cut, camera

    def __call__(self, unit: np.ndarray) -> torch.Tensor:
        """Frames of gowns: (N, 6) in [0, 1] -> (N, T, 2, S, S).

        Raises:
            CaretreeError: none of them can be simulated.
        """
        depth: list[np.ndarray | None] = []
        for one in np.clip(unit, 0.0, 1.0):
            try:
                depth.append(film(to_spec(one, self.cut), self.camera).depth)
            except CaretreeError:
                depth.append(None)
        usable = [d for d in depth if d is not None]
        if not usable:
            raise CaretreeError(f"no gown like '{self.cut.name}' with the parameters found can be simulated")
        return torch.from_numpy(frames_of(np.array([usable[0] if d is None else d for d in depth])))
