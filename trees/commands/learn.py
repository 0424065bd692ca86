"""`caretree learn`: the learned parts' own command line, given the ways of seeing that it may compare.

`learning` and `perception` do not know each other; here both are known.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ...learning.cli import main as learn

if TYPE_CHECKING:
    from ...learning.vision.evaluate import Seer


def seers(network: Path | None) -> Mapping[str, Seer]:
    """The network in a file, or the packaged one, and the classical perception."""
    from .seers import ClassicalSeer, LearnedSeer

    return {"learned": LearnedSeer(network), "classical": ClassicalSeer()}


def main(argv: list[str]) -> int:
    """Run `caretree learn ...`."""
    return learn(argv, seers)
