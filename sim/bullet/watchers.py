"""Those who watch the room, frame by frame: the recorder and the live view, each behind a fence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from ..fence import fenced
from ..record.recorder import FRAME_PERIOD, Recorder
from ..record.truth import TruthFrame, TruthStatic
from ..render.camera import Renderer
from ..render.live_view import SIZE
from .backdrop import SPECTATOR, SPECTATOR_SIZE

PICTURE_PERIOD = 2 * FRAME_PERIOD  # of the video [s]


class View(Protocol):
    """Shows pictures of the room, drawn from a camera pose (4, 4)."""

    def serve(self, draw: Callable[[np.ndarray], np.ndarray]) -> None:
        """Show what `draw` gives."""
        ...


class Watchers:
    """Shows them the room when it is time.

    Args:
        frame: gives everything that is known about this instant.
        draw: gives the renderer with everything where it is now.
    """

    def __init__(self, frame: Callable[[], TruthFrame], draw: Callable[[], Renderer]) -> None:
        self._frame, self._draw = frame, draw
        self._on_error: Callable[[Exception], None] = lambda error: None
        self._watchers: list[Callable[[float], None]] = []
        self._next_frame = self._next_picture = 0.0

    def record(self, recorder: Recorder, static: TruthStatic, on_error: Callable[[Exception], None]) -> None:
        """Give every frame from now on to `recorder`, and whatever fails in showing or recording it to `on_error`."""

        def watch(time: float) -> None:
            recorder.frame(self._frame())
            if time >= self._next_picture - 1e-9:
                self._next_picture += PICTURE_PERIOD
                recorder.picture(time, self._draw().render(SPECTATOR, SPECTATOR_SIZE).rgb)

        recorder.begin(static)
        self._on_error = on_error
        self._add(watch)

    def show(self, view: View) -> None:
        """Let `view` draw every frame from now on that somebody asks for."""
        self._add(lambda time: view.serve(lambda pose: self._draw().render(pose, SIZE).rgb))

    def _add(self, watch: Callable[[float], None]) -> None:
        self._watchers.append(fenced(watch, lambda error: self._on_error(error)))

    def due(self, time: float) -> bool:
        """Whether a frame is to be shown at `time` [s]."""
        return time >= self._next_frame - 1e-9

    def look(self, time: float) -> None:
        """Show this frame to all."""
        self._next_frame += FRAME_PERIOD
        for watch in self._watchers:
            watch(time)
