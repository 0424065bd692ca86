"""`caretree replay`: the same run again, compared."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..campaign.replay import replay
from ..run.stop_signals import StopSignals


def main(options: argparse.Namespace) -> int:
    """Replay the record; 0 when the traces are equal, else 1.

    Raises:
        CaretreeError: the record cannot be used.
    """
    with StopSignals():
        result = replay(Path(options.directory))
    if result.same:
        print(f"the run in {options.directory} repeats exactly")
        return 0
    print(result.difference)
    if result.changed:
        print(result.changed)
    if result.versions:
        print("versions that changed: " + "; ".join(result.versions))
    return 1
