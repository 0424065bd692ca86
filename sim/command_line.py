"""What every command line of the project shares: one sentence for a user's mistake, and the exit status.

Nothing heavy is imported here: `--help` answers at once.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn

from .errors import CaretreeError
from .extras import MissingExtra, missing_extra

BAD_INPUT = 2
INTERRUPTED = 130  # as shells count a Ctrl-C
SEEDS = 2**32
PORTS = 2**16
PICTURES = ("png", "jpg", "jpeg", "webp", "tif", "tiff", "pdf", "ps", "eps", "svg", "svgz")  # matplotlib's
RATES = (0.1, 1000.0)  # [Hz] ticks or measurements a second


class CommandParser(argparse.ArgumentParser):
    """Says what is wrong in one sentence, without the usage text; its subcommands do too."""

    def error(self, message: str) -> NoReturn:
        """Turn argparse's error into the project's.

        Raises:
            CaretreeError: always.
        """
        raise CaretreeError(f"{message} (see {self.prog} --help)")

    # argparse's own is overloaded by what its namespace may be
    def parse_args(self, args: Any = None, namespace: Any = None) -> Any:  # pyright: ignore[reportIncompatibleMethodOverride]
        """As argparse's; what nobody knows is told with the help of the command that it was given to.

        Raises:
            CaretreeError: an argument is wrong, unknown or empty.
        """
        args = list(sys.argv[1:] if args is None else args)
        for before, text in zip((self.prog, *args), args, strict=False):
            if not text or (text.startswith("--") and text.endswith("=")):  # as `--out "$DIR"` is where DIR is not set
                raise CaretreeError(f"nothing is given with {text[:-1] or before} (see {self.prog} --help)")
        found, unknown = self.parse_known_args(args, namespace)
        if unknown:
            command = getattr(found, "command", None)
            program = f"{self.prog} {command}" if command else self.prog
            raise CaretreeError(f"unrecognized arguments: {' '.join(unknown)} (see {program} --help)")
        return found


def whole_number(text: str) -> int:
    """Type of an argument that is 0 or more.

    Raises:
        ArgumentTypeError: it is not.
    """
    if not text.isascii() or not text.isdigit():
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number")
    return int(text)


def at_least_one(text: str) -> int:
    """Type of an argument that counts what there must be one of, such as runs at the same time.

    Raises:
        ArgumentTypeError: it is no such number.
    """
    if not text.isascii() or not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r}, but a whole number of at least 1 is asked for")
    return int(text)


def seed(text: str) -> int:
    """Type of an argument that seeds a random generator.

    Raises:
        ArgumentTypeError: it is none.
    """
    if not text.isascii() or not text.isdigit() or int(text) >= SEEDS:
        raise argparse.ArgumentTypeError(f"{text!r} is no seed: a whole number from 0 to {SEEDS - 1} is asked for")
    return int(text)


def port(text: str) -> int:
    """Type of an argument that names a port.

    Raises:
        ArgumentTypeError: it is none.
    """
    if not text.isascii() or not text.isdigit() or not 0 < int(text) < PORTS:
        raise argparse.ArgumentTypeError(f"{text!r} is no port: a whole number from 1 to {PORTS - 1} is asked for")
    return int(text)


def rate(text: str) -> float:
    """Type of an argument that says how often a second.

    Raises:
        ArgumentTypeError: it does not.
    """
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not RATES[0] <= value <= RATES[1]:
        raise argparse.ArgumentTypeError(f"{text!r} is no rate: {RATES[0]:g} to {RATES[1]:g} Hz is asked for")
    return value


def picture_file(text: str) -> str:
    """Type of an argument that names a picture to write: its suffix says of which kind, before any work is done for it.

    Raises:
        ArgumentTypeError: there is no such kind.
    """
    if Path(text).suffix[1:].lower() not in PICTURES:
        raise argparse.ArgumentTypeError(f"{text!r} is no picture; it may end in .{', .'.join(PICTURES)}")
    return text


def drop_output() -> None:
    """Send what is still printed nowhere, as its reader has gone: printing it must not fail again."""
    with contextlib.suppress(OSError, ValueError):  # where no file stands behind stdout there is nothing to do
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


def _complain(text: str) -> None:
    """One line, whatever the user's own words in it hold."""
    text = "".join(sign if sign.isprintable() else repr(sign)[1:-1] for sign in text)
    with contextlib.suppress(OSError):  # the terminal may have gone
        print(text, file=sys.stderr, flush=True)


def answered(
    program: str, command: Callable[[], int], *, interrupted: str = "interrupted", extra: str | None = None
) -> int:
    """Run a command and tell a user's mistake, a lost file, a missing extra or a Ctrl-C in one sentence.

    Args:
        program: name in front of the sentence.
        command: returns the exit status.
        interrupted: what is said after a Ctrl-C.
        extra: that brings all that the command needs; by default the one of the package that is missing.

    Returns:
        The exit status: the command's own, `BAD_INPUT`, `INTERRUPTED`, or 1 where the reader of the output has gone.
    """
    try:
        return command()
    except (ModuleNotFoundError, MissingExtra) as error:
        missing = missing_extra(error, extra)
        if missing is None:
            raise  # of the user's own files, or a mistake of ours
        _complain(f"{program}: {missing}")
        return BAD_INPUT
    except CaretreeError as error:
        _complain(f"{program}: {error}")
        return BAD_INPUT
    except BrokenPipeError:  # the reader of our output has gone
        drop_output()
        return 1
    except OSError as error:
        where = f": {error.filename}" if error.filename else ""
        _complain(f"{program}: {error.strerror or error}{where}")
        return BAD_INPUT
    except KeyboardInterrupt:
        _complain(f"{program}: {interrupted}")
        return INTERRUPTED
