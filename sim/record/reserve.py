"""Room kept free on the disk for the end of a record, for the case that everything else has filled it."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from .spool import disk_error

RESERVE = 1 << 20  # [bytes] a safe stop of a minute writes 0.1 MB of trace, run.json and the page take 0.2 MB


class Reserve:
    """A file of no use but its size, removed to make room.

    Args:
        path: of the file; replaced if it exists.
        size: of the file [bytes].

    Raises:
        RecordError: the disk is full already, or the folder cannot be written.
    """

    def __init__(self, path: Path, size: int = RESERVE) -> None:
        self._path = path
        try:
            path.write_bytes(os.urandom(size))  # what cannot be compressed takes its room on every disk
        except OSError as error:
            self.free()
            raise disk_error(error, f"keeping room for the record in {path.parent}") from error

    def free(self) -> None:
        """Give the room to whoever writes next.  May be called twice."""
        with suppress(OSError):  # a disk that may not be written: whoever writes next is told
            self._path.unlink(missing_ok=True)
