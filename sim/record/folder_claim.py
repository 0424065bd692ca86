"""One run writes one folder: whoever comes second is told so instead of spoiling the record."""

from __future__ import annotations

import os
from pathlib import Path

from ..errors import RecordError
from .file_lock import lock_file
from .record import RUN_FILE, TRACE_FILE, is_finished, read_run
from .spool import disk_error


class FolderTakenError(RecordError):
    """Another run writes the folder, or has finished in it."""


class FolderClaim:
    """The right to write one run's folder, held by a lock on its trace file until it is released.

    Args:
        directory: created if needed.

    Raises:
        FolderTakenError: another run writes there now, or a finished run is there.
        RecordError: the folder cannot be written, or its run.json is damaged.
    """

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        self._file: int | None = None
        if directory.exists() and not directory.is_dir():
            raise RecordError(f"{directory} is a file, but a folder for the record is asked for")
        try:
            directory.mkdir(parents=True, exist_ok=True)
            self._file = lock_file(directory / TRACE_FILE)
        except OSError as error:
            raise disk_error(error, f"opening the record in {directory}") from error
        if self._file is None:
            raise FolderTakenError(f"another run is writing {directory}: give another folder with --out or wait for it")
        try:
            if (directory / RUN_FILE).exists() and is_finished(read_run(directory)):
                raise FolderTakenError(
                    f"{directory} already holds a finished run; give another folder with --out or remove it"
                )
        except RecordError:
            self.release()
            raise

    def release(self) -> None:
        """Let others have the folder, and take it away where nothing was written into it.  May be called twice."""
        if self._file is None:
            return
        trace = self.directory / TRACE_FILE
        try:
            if not (self.directory / RUN_FILE).exists() and not os.fstat(self._file).st_size:
                trace.unlink()
                self.directory.rmdir()
        except OSError:  # something else is in the folder: it stays
            pass
        os.close(self._file)
        self._file = None


def claim_free(parent: Path, stem: str) -> FolderClaim:
    """The first of `parent`/stem, `parent`/stem-2, ... in which no run was begun.

    Raises:
        RecordError: `parent` cannot be written.
    """
    number = 1
    while True:
        directory = parent / (stem if number == 1 else f"{stem}-{number}")
        number += 1
        if (directory / RUN_FILE).exists():
            continue
        try:
            return FolderClaim(directory)
        except FolderTakenError:
            continue
