"""`caretree learn`: datasets, training and evaluation of the learned parts."""

from __future__ import annotations

import importlib

from ..sim.errors import CaretreeError

USAGE = """usage: caretree learn PART COMMAND ...

parts:
  physics    a garment's physics from one depth clip of it falling
"""


def main(argv: list[str]) -> int:
    """Hand over to the part's own command line; 0 when all went well.

    Raises:
        CaretreeError: no such part.
    """
    if not argv or argv[0] in ("-h", "--help"):
        print(USAGE, end="")
        return 0
    if argv[0] != "physics":
        raise CaretreeError(f"`caretree learn` has no part '{argv[0]}', it has physics")
    return int(importlib.import_module(".physics.cli", __package__).main(argv[1:]))
