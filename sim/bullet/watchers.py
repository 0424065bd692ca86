"""Those who watch the room, frame by frame: the recorder, its video and the live view, each behind a fence."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from ..abilities import RoomView
from ..fence import fenced
from ..record.recorder import FRAME_PERIOD, Recorder
from ..record.truth import TruthFrame, TruthStatic
from ..render.camera import Renderer
from ..render.diorama import Diorama
from ..render.film import Caption, Film, Moment
from ..world import Frame

PICTURE_PERIOD = 2 * FRAME_PERIOD  # of the video [s]


class Watchers:
    """Shows them the room when it is time.

    Args:
        frame: gives everything that is known about this instant.
        draw: gives the renderer with everything where it is now.
        diorama: what people see of that.
        looks: by camera, what it saw last.
    """

    def __init__(
        self,
        frame: Callable[[], TruthFrame],
        draw: Callable[[], Renderer],
        diorama: Diorama,
        looks: Mapping[str, Frame],
    ) -> None:
        self._frame, self._draw, self._diorama, self._looks = frame, draw, diorama, looks
        self._on_error: Callable[[Exception], None] = lambda error: None
        self._watchers: list[Callable[[float], None]] = []
        self._next_frame = self._next_picture = 0.0

    def record(self, recorder: Recorder, static: TruthStatic, on_error: Callable[[Exception], None]) -> None:
        """Give every frame from now on to `recorder`, and whatever fails in showing or recording it to `on_error`."""
        film = Film(self._diorama.renderer.light, self._diorama.shell)

        def watch(time: float) -> None:
            truth = self._frame()
            recorder.frame(truth)
            if recorder.films and time >= self._next_picture - 1e-9:
                self._next_picture += PICTURE_PERIOD
                head = self._looks.get("head")
                moment = Moment(
                    time=time,
                    triangles=self._room().triangles(),
                    hands=truth.gripper_pose[:, :3],
                    head=None if head is None else (head.rgb, head.stamp),
                    caption=Caption(*recorder.caption),
                )
                recorder.film(time, partial(film.draw, moment))

        recorder.begin(static)
        self._on_error = on_error
        self._add(watch)

    def show(self, view: RoomView) -> None:
        """Let `view` show every frame from now on."""
        self._add(lambda time: view.show(time, self._room()))

    def _room(self) -> Renderer:
        return self._diorama.follow(self._draw())

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
