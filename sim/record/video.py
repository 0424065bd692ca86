"""A run as H.264 in an mp4, written picture by picture at the pace of the world's clock."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import RecordError
from .spool import disk_error

if TYPE_CHECKING:
    from fractions import Fraction

TICKS = 90_000  # per second, the usual clock of H.264


class VideoWriter:
    """Encodes pictures as they come; memory does not grow with the length of the run.

    Pictures carry their own time, so an uneven rate plays at the right speed; second 0 of the file is the
    first picture, whose world time is kept in `t_start`.  The file is fragmented
    while it grows and turned into a plain mp4 at the end: a killed run leaves a playable video.

    Args:
        path: of the mp4.
        width, height: size of every picture, even numbers [px].
        quality: constant rate factor of x264, 18 (fine) to 30 (coarse).
        keyframe_every: pictures; a kill loses as many, and as many are decoded to show any one of them.

    Raises:
        RecordError: the size is odd, or the file cannot be written.
    """

    def __init__(self, path: Path, *, width: int, height: int, quality: int = 24, keyframe_every: int = 25) -> None:
        if width < 2 or height < 2 or width % 2 or height % 2:
            raise RecordError(f"pictures are {width} x {height}, but H.264 asks for even width and height")
        import av

        self.path = path
        self.t_start: float | None = None  # [s] world clock of the first picture
        self._shape = (height, width, 3)
        self._last = -1
        with self._told("opening"):
            self._container: Any = av.open(
                str(path),
                "w",
                format="mp4",
                options={"movflags": "+hybrid_fragmented+frag_keyframe", "flush_packets": "1"},
            )  # each fragment at once, not every 32 kB
            stream: Any = self._container.add_stream("libx264", rate=25)
            stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
            # one thread: physics owns the cores
            options = {"crf": str(quality), "preset": "veryfast", "threads": "1", "bf": "0"}
            stream.options = options | {"g": str(keyframe_every)}
            stream.time_base = stream.codec_context.time_base = _time_base()
            self._container.start_encoding()  # opens the file now, not at the first picture
        self._stream = stream

    def add(self, t: float, image: np.ndarray) -> None:
        """Append a picture shown from `t` [s] on.

        image: (H, W, 3) uint8.

        Raises:
            RecordError: the picture has another size or type, `t` does not grow, or the disk is full.
        """
        import av

        if image.shape != self._shape or image.dtype != np.uint8:
            raise RecordError(f"picture is {image.dtype} {image.shape}, but uint8 {self._shape} is asked for")
        start = t if self.t_start is None else self.t_start
        ticks = round((t - start) * TICKS)
        if ticks <= self._last:
            raise RecordError(f"picture at {t:.3f} s comes after one at {start + self._last / TICKS:.3f} s")
        self.t_start = start
        self._last = ticks
        frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(image), format="rgb24")
        frame.pts, frame.time_base = ticks, _time_base()
        with self._told("writing"):
            for packet in self._stream.encode(frame):
                self._container.mux(packet)

    def close(self) -> None:
        """Flush and close; may be called twice.

        Raises:
            RecordError: the disk is full.
        """
        if self._container is None:
            return
        container, self._container = self._container, None
        with self._told("closing"):
            if self._last >= 0:
                for packet in self._stream.encode(None):
                    container.mux(packet)
            container.close()

    @contextmanager
    def _told(self, doing: str) -> Iterator[None]:
        """Turn what the system or the encoder raises into one sentence."""
        from av.error import FFmpegError

        try:
            yield
        except OSError as error:
            raise disk_error(error, f"{doing} {self.path}") from error
        except FFmpegError as error:
            raise RecordError(f"{doing} {self.path} failed: {error}") from error


def _time_base() -> Fraction:
    from fractions import Fraction

    return Fraction(1, TICKS)


def read_pictures(path: Path, times: list[float]) -> list[np.ndarray]:
    """The picture shown at each of `times` [s from the start of the file], in the order given.

    A video cut short by a kill is read up to the cut.

    Returns:
        One (H, W, 3) uint8 for each time; a time past the end gives the last picture.

    Raises:
        RecordError: the video is missing or damaged.
    """
    import av
    from av.error import FFmpegError

    found: dict[int, np.ndarray] = {}
    order = sorted(range(len(times)), key=times.__getitem__)
    shown: Any = None
    try:
        with av.open(str(path)) as container:
            for frame in container.decode(video=0):
                while shown is not None and order and times[order[0]] < (frame.time or 0.0):
                    found[order.pop(0)] = shown.to_ndarray(format="rgb24")
                if not order:
                    break
                shown = frame
    except (OSError, FFmpegError) as error:
        if shown is None:
            raise RecordError(f"{path} is not a readable video") from error
    if shown is None:
        raise RecordError(f"{path} holds no picture")
    found.update({index: shown.to_ndarray(format="rgb24") for index in order})
    return [found[index] for index in range(len(times))]
