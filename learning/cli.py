"""`caretree learn`: datasets, training and evaluation of the learned parts."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..sim.errors import CaretreeError

Seers = Callable[[Path | None], Mapping[str, Any]]  # file of a network -> ways of seeing, to be compared

USAGE = """usage: caretree learn PART COMMAND ...

parts:
  physics    a garment's physics from one depth clip of it falling
  vision     gown and person in a picture, whatever their colours
  pregrasp   the manipulation that isolates a corner of a gown in one hand, and grasps it
"""


def main(argv: list[str], seers: Seers | None = None) -> int:
    """Hand over to the part's own command line; 0 when all went well.

    Args:
        argv: part, command and what it takes.
        seers: gives the ways of seeing that `vision evaluate` compares.

    Raises:
        CaretreeError: no such part.
    """
    if not argv or argv[0] in ("-h", "--help"):
        print(USAGE, end="")
        return 0
    if argv[0] == "vision":
        return int(importlib.import_module(".vision.cli", __package__).main(argv[1:], seers))
    if argv[0] == "pregrasp":
        return int(importlib.import_module(".pregrasp.cli", __package__).main(argv[1:]))
    if argv[0] != "physics":
        raise CaretreeError(f"`caretree learn` has no part '{argv[0]}', it has physics, vision and pregrasp")
    return int(importlib.import_module(".physics.cli", __package__).main(argv[1:]))
