"""Simulated clips as frames, for methods that simulate what they found."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ....sim.errors import CaretreeError
from ....sim.scene.gown import GownSpec
from ..clips.camera import ClipCamera, standard_camera
from ..clips.depth_noise import disturb
from ..clips.frames import frames_of
from ..clips.parameters import to_spec
from ..clips.render_clip import path_of, render_path

DRAWS = 4  # of the noise on a rough clip; their mean is what such a clip is expected to look like


class Simulator:
    """Renders falling gowns of known cuts; one that cannot be simulated gets the frames of another that could.

    Args:
        cuts: of each gown, or one cut for all.
        camera: where they are said to be seen from; the usual place when omitted.
    """

    def __init__(self, cuts: GownSpec | Sequence[GownSpec], camera: ClipCamera | None = None) -> None:
        self.cuts, self.camera = cuts, camera or standard_camera()
        self._falls: dict[int, tuple[bytes, GownSpec, np.ndarray]] = {}  # the last of each, to render it again

    def __call__(self, unit: np.ndarray, misplaced: np.ndarray | None = None) -> np.ndarray:
        """Frames of gowns.

        Args:
            unit: (N, 6) parameters in [0, 1].
            misplaced: (N, 6) how far each camera is from where it is said to be; given, the clips have the noise and
                the gaps of a real camera too, on average.

        Returns:
            (N, T, 2, S, S).

        Raises:
            CaretreeError: none of them can be simulated.
        """
        frames = [
            self._one(k, one, None if misplaced is None else misplaced[k])
            for k, one in enumerate(np.clip(unit, 0.0, 1.0))
        ]
        usable = [f for f in frames if f is not None]
        if not usable:
            raise CaretreeError(f"no gown like '{self._cut(0).name}' with the parameters found can be simulated")
        return np.array([usable[0] if f is None else f for f in frames])

    def _cut(self, k: int) -> GownSpec:
        return self.cuts if isinstance(self.cuts, GownSpec) else self.cuts[k]

    def _one(self, k: int, unit: np.ndarray, misplaced: np.ndarray | None) -> np.ndarray | None:
        key, spec, path = self._falls.get(k, (b"", None, None))
        try:
            if spec is None or path is None or key != unit.tobytes():
                spec = to_spec(unit, self._cut(k))
                path = path_of(spec)
                self._falls[k] = (unit.tobytes(), spec, path)
            if misplaced is None:
                return frames_of(render_path(spec, path, self.camera)[None])[0]
            depth = render_path(spec, path, self.camera.moved(misplaced))
            if not np.isfinite(depth).any(axis=(1, 2)).all():
                return None
            rng = np.random.default_rng(0)  # the same noise at every call, so that only the gown and camera differ
            noisy = frames_of(np.array([disturb(depth, rng) for _ in range(DRAWS)]))
            return noisy.astype(np.float32).mean(axis=0)
        except CaretreeError:
            return None
