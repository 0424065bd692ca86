"""What an error of somebody else's code is told as: what it said, and the line of theirs that it came from.

A robot's driver may raise anything, and some end the program (`sys.exit`), which nobody may do while a robot moves.
"""

from __future__ import annotations

import sys
import traceback
from pathlib import Path

from .errors import CaretreeError

OF_FOREIGN_CODE = (Exception, SystemExit, GeneratorExit)  # what is caught where such code is called
LIBRARIES = (sys.prefix, sys.base_prefix, "<")  # where code lies that nobody here has written
PACKAGE = __name__.partition(".")[0] + "."


def told(error: BaseException) -> str:
    """One clause for `error`, with the place it came from."""
    if isinstance(error, SystemExit):
        text = f"sys.exit({'' if error.code is None else repr(error.code)}) was called"
    elif isinstance(error, (CaretreeError, OSError)):
        text = str(error)
    else:
        text = f"{type(error).__name__}: {error}" if str(error) else ""
    at = place(error)
    return (text or type(error).__name__) + (f" (at {at})" if at else "")


def place(error: BaseException) -> str:
    """`file:line` of the innermost code that is neither a library's nor this package's; empty where there is none."""
    for frame, line in reversed(list(traceback.walk_tb(error.__traceback__))):
        file, module = frame.f_code.co_filename, str(frame.f_globals.get("__name__", ""))
        if not file.startswith(LIBRARIES) and not module.startswith(PACKAGE):
            return f"{Path(file).name}:{line}"
    return ""
