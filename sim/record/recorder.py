"""Writes the record of a run: truth frames from the world, trace events from the runner, pictures for the video."""

from __future__ import annotations

import hashlib
import json
import shutil
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..blame import told
from ..errors import RecordError
from ..fence import said
from .background import Background
from .folder_claim import FolderClaim
from .measured import MeasuredLog
from .record import (
    ERRORS_FILE,
    LOOKS_FOLDER,
    MEASURED_FILE,
    REPORT_FILE,
    RESERVE_FILE,
    RUN_FILE,
    SPOOL_FOLDER,
    TRACE_FILE,
    TREE_FILE,
    TRUTH_FILE,
    VIDEO_FILE,
    RunResult,
    peak_memory,
    versions,
    write_run,
)
from .reserve import Reserve
from .spool import Spool, disk_error, write_npz
from .truth import TruthFrame, TruthStatic
from .video import VideoWriter

PICTURE_GAP_MAX = (
    0.64  # [s] of world clock: so far apart are pictures of the video at most, however slow they are drawn
)
FRAME_PERIOD = 0.08  # [s] of world clock between truth frames: 12.5 a second, DESIGN.md asks for at least 10


class Recorder:
    """The record of one run, safe on disk at every moment.

    The world calls `begin` once and `frame` every `FRAME_PERIOD`; the runner calls `event` and at the end
    `finish`; whoever renders calls `picture`.  Killed in between, the folder keeps run.json without an
    outcome, the trace so far and the frames so far.

    The first error ends frames and pictures, and room kept for that case goes to the trace and to run.json, which
    tell how the run ended: they are still written where that is possible.

    Args:
        directory: created if needed, or the claim on it; given back at the end.
        task, seed, world: what runs, on which world.
        parameters: everything else needed to run it again (gown, person, faults, model).
        films: whether there is a video: drawing it costs about as much processor time as the fastest physics.

    Attributes:
        films: the same.
        measured: what the robot measures; given to it by the runner, and written at the end.
        caption: stage and skill, written on the pictures of the video.

    Raises:
        RecordError: the folder cannot be written, another run is writing it, or it already holds a finished run.
    """

    def __init__(
        self,
        directory: Path | str | FolderClaim,
        *,
        task: str,
        seed: int,
        world: str,
        parameters: Mapping[str, Any] | None = None,
        films: bool = True,
    ) -> None:
        self.films = films
        self._claim = directory if isinstance(directory, FolderClaim) else FolderClaim(Path(directory))
        self.directory = self._claim.directory
        self._clear_unfinished()
        self._run: dict[str, Any] = {
            "task": task,
            "seed": seed,
            "world": world,
            "outcome": None,
            "reason": None,
            "stages": [],
            "parameters": dict(parameters or {}),
            "versions": versions(),
        }
        self._started = time.perf_counter(), time.process_time(), time.thread_time()
        self._hash = hashlib.sha256()
        self._spool: Spool | None = None
        self._video: VideoWriter | None = None
        self._background: Background | None = None
        self._filmed = float("-inf")
        self.measured = MeasuredLog()
        self.caption: tuple[str, str] = ("", "")
        self._problem: RecordError | None = None  # the first
        self._done = False
        try:
            self._trace = (self.directory / TRACE_FILE).open("w", encoding="utf-8", buffering=1)
        except OSError as error:
            self._claim.release()
            raise disk_error(error, f"opening the record in {self.directory}") from error
        self._reserve: Reserve | None = None
        try:
            self._reserve = Reserve(self.directory / RESERVE_FILE)
            write_run(self.directory, self._run)
        except RecordError:
            self.close()
            raise

    def _clear_unfinished(self) -> None:
        """Make room where a run was cut short."""
        if not (self.directory / RUN_FILE).exists():
            return
        for folder in (SPOOL_FOLDER, LOOKS_FOLDER):
            shutil.rmtree(self.directory / folder, ignore_errors=True)
        for name in (TREE_FILE, TRUTH_FILE, VIDEO_FILE, REPORT_FILE, ERRORS_FILE, RESERVE_FILE, MEASURED_FILE):
            (self.directory / name).unlink(missing_ok=True)

    def begin(self, static: TruthStatic) -> None:
        """Say what stays the same, before the first frame.

        Raises:
            RecordError: said twice, or the disk is full.
        """
        if self._spool is not None:
            raise RecordError("the recorder was begun twice")
        self._spool = Spool(self.directory / SPOOL_FOLDER, static)

    def frame(self, truth: TruthFrame) -> None:
        """Append one frame of truth; on disk when this returns.  Does nothing after an error.

        Raises:
            RecordError: `begin` was not called, a shape is wrong, or the disk is full.
        """
        if self._spool is None:
            raise RecordError("a frame came before the recorder was begun")
        if self._problem is None:
            with self._noted():
                self._spool.append(truth)

    def event(self, event: Mapping[str, Any]) -> None:
        """Append one line to the trace and to its hash.

        The hash covers the line as written, so `event` must hold nothing that differs between two equal
        runs (no wall time, no paths).

        Raises:
            RecordError: the disk is full.
        """
        line = json.dumps(event, sort_keys=True, separators=(",", ":")) + "\n"
        self._hash.update(line.encode())
        with self._noted():
            try:
                self._trace.write(line)
            except OSError as error:
                self._make_room()
                with suppress(OSError):
                    self._trace.flush()  # the line has stayed in the buffer
                raise disk_error(error, f"writing {self.directory / TRACE_FILE}") from error

    def picture(self, t: float, image: np.ndarray) -> None:
        """Add one picture to the video, shown at `t` [s] of the world clock.  Does nothing after an error.

        image: (H, W, 3) uint8, the same even size every time.

        Raises:
            RecordError: the size differs or the disk is full.
        """
        if self._problem is not None:
            return
        with self._noted():
            self._add_picture(t, image)

    def _add_picture(self, t: float, image: np.ndarray) -> None:
        if self._video is None:
            self._video = VideoWriter(self.directory / VIDEO_FILE, width=image.shape[1], height=image.shape[0])
        self._video.add(t, image)

    def _film(self, t: float, draw: Callable[[], np.ndarray]) -> None:
        try:
            self._add_picture(t, draw())
        except RecordError:
            raise
        except Exception as error:
            raise RecordError(f"a picture of the video cannot be drawn: {said(error)}") from error

    def film(self, t: float, draw: Callable[[], np.ndarray]) -> None:
        """Have a picture drawn and added to the video beside the run; left out where drawing cannot keep up.

        Args:
            t: from when on it is shown [s] of the world clock.
            draw: gives it, (H, W, 3) uint8; called in a thread of its own, so it must touch nothing that changes.

        Raises:
            RecordError: an earlier picture could not be added.
        """
        if self._problem is not None or not self.films:
            return
        with self._noted():
            self._background = self._background or Background()
            if self._background.give(partial(self._film, t, draw), wait=t - self._filmed > PICTURE_GAP_MAX - 1e-9):
                self._filmed = t

    @contextmanager
    def _noted(self) -> Iterator[None]:
        """Keep the first error, and make room once there is one."""
        try:
            yield
        except RecordError as error:
            self._problem = self._problem or error
            self._make_room()
            raise

    @contextmanager
    def _kept(self) -> Iterator[None]:
        """Keep any error for the end of `finish`: none may keep the outcome from being written."""
        with suppress(RecordError), self._noted():
            try:
                yield
            except RecordError:
                raise
            except Exception as error:
                raise RecordError(f"the record in {self.directory} is not whole: {told(error)}") from error

    def _make_room(self) -> None:
        if self._reserve is not None:
            self._reserve.free()

    def note(self, **entries: Any) -> None:
        """Keep further entries of run.json, to be written with the outcome."""
        self._run.update(entries)

    def finish(self, result: RunResult) -> None:
        """Write truth.npz and the outcome, and close everything.

        The outcome is written even when the disk is too full for truth.npz; the frames then stay in
        the spool, and the error is raised afterwards.

        Raises:
            RecordError: something could not be written, now or before, or the run was finished before.
        """
        if self._done:
            raise RecordError("the recorder was finished twice")
        self._done = True
        try:
            self._close_files()
            self._finish(result)
        finally:
            self._claim.release()
        if self._problem is not None:
            raise self._problem

    def _finish(self, result: RunResult) -> None:
        began = time.perf_counter(), time.thread_time()
        if self._spool is not None and self._spool.frames:
            with self._kept():
                write_npz(self._spool.folder, self.directory / TRUTH_FILE)
                shutil.rmtree(self._spool.folder)
        with self._kept():
            self.measured.write(self.directory)
        ended = time.perf_counter(), time.thread_time()
        whole = time.process_time() - self._started[1]
        self._run.update(
            result.fields(),
            wall_time_s=round(ended[0] - self._started[0], 3),
            processor_time_s=round(whole, 3),
            beside_time_s=round(max(whole - (ended[1] - self._started[2]), 0.0), 3),  # of other threads: the video
            trace_hash=result.trace_hash or self._hash.hexdigest(),
        )
        for name, now, before in zip(("timing", "processor_timing"), ended, began, strict=True):
            self._run[name]["record"] = round(self._run[name].get("record", 0.0) + now - before, 3)
        self._run["peak_memory_mb"] = peak_memory()
        if self._video is not None:
            self._run["video_start_s"] = self._video.t_start
        self._make_room()
        write_run(self.directory, self._run)

    def close(self) -> None:
        """Release files without an outcome; the record stays readable as a run cut short.  May be called twice."""
        self._close_files()
        self._make_room()
        self._claim.release()

    def _close_files(self) -> None:
        """Close what is open; an error keeps neither the others nor run.json from being written."""
        for file in (self._background, self._trace, self._spool, self._video):  # nobody films into a closed video
            if file is not None:
                with self._kept():
                    try:
                        file.close()
                    except OSError as error:
                        raise disk_error(error, f"closing the record in {self.directory}") from error
