"""A lock on a file, so that two processes do not write the same thing at once."""

from __future__ import annotations

import os
from pathlib import Path


def lock_file(path: Path) -> int | None:
    """A descriptor of `path`, created if needed, that holds its lock; None where another process holds it.

    Closing the descriptor gives the lock back, and so does the end of the process, however it ends: no lock is ever
    stale.  Where the file system knows no locks, the lock is taken for granted.

    Raises:
        OSError: the file cannot be opened.
    """
    try:
        import fcntl
    except ImportError:  # not on Windows
        return os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    while True:
        file = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(file)
            return None
        except OSError:
            return file
        try:
            if os.path.samestat(os.fstat(file), os.stat(path)):
                return file
        except FileNotFoundError:
            pass
        os.close(file)  # its last holder took the file away between the two calls
