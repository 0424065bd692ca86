"""The mark of a trial at work: a locked file beside its folder, so that two campaigns can share the seeds."""

from __future__ import annotations

import json
import os
import platform
import time
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from ...sim.record.file_lock import lock_file

SUFFIX = ".running"
BEAT = 5.0  # [s] between two signs of life


@dataclass(frozen=True, kw_only=True)
class Heartbeat:
    """What the file says.

    Attributes:
        key: of the campaign that runs the trial.
        host, process: that runs it.
        began, last: wall clock at its begin and at the last sign of life [s since 1970].
    """

    key: str
    host: str
    process: int
    began: float
    last: float


class Running:
    """The right to run one trial, held until it is released, or until the process ends, however it ends.

    Args:
        folder: of the trial; the file lies beside it.
        key: of the campaign.
    """

    def __init__(self, folder: Path, key: str) -> None:
        self._path = folder.with_name(folder.name + SUFFIX)
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._file = lock_file(self._path)
        now = time.time()
        self._told = Heartbeat(key=key, host=platform.node(), process=os.getpid(), began=now, last=0.0)
        if self._file is not None:
            self.beat()

    @property
    def mine(self) -> bool:
        """Whether the trial is this holder's to run; another one runs it now if not."""
        return self._file is not None

    def beat(self) -> None:
        """Say that it goes on; on disk every `BEAT` seconds."""
        now = time.time()
        if self._file is None or now - self._told.last < BEAT:
            return
        self._told = replace(self._told, last=now)
        text = json.dumps(asdict(self._told)).encode()
        os.pwrite(self._file, text.ljust(256), 0)

    def release(self) -> None:
        """Let others have it.  May be called twice."""
        if self._file is not None:
            self._path.unlink(missing_ok=True)
            os.close(self._file)
            self._file = None


def read_running(folder: Path) -> Heartbeat | None:
    """The last sign of life of a trial that is not over; None where there is none."""
    try:
        return Heartbeat(**json.loads(folder.with_name(folder.name + SUFFIX).read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError):
        return None


def others(directory: Path, key: str) -> str:
    """A sentence about a campaign of another key that works in this folder now; empty where there is none."""
    for path in sorted(directory.glob(f"*/*{SUFFIX}")):
        beat = read_running(path.with_suffix(""))
        held = lock_file(path)
        if held is not None:  # nobody's: its campaign was killed
            os.close(held)
        elif beat is not None and beat.key != key:
            return f"process {beat.process} on {beat.host} runs {path.stem} there, of other sources or versions"
    return ""
