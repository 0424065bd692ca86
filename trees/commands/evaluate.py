"""`caretree evaluate DIR`: is the person dressed, and unharmed?  Decided from the recorded geometry alone."""

from __future__ import annotations

import argparse
import json
from pathlib import Path


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the command line; `main` runs it."""
    parser = subparsers.add_parser(
        "evaluate",
        help="say from the record alone whether the person is dressed and unharmed",
        description="Decide from DIR/truth.npz alone whether the person is dressed and, where the record tells, "
        "unharmed.  Exit status 0: both, 1: not, 2: the record cannot be read.",
    )
    parser.add_argument("directory", type=Path, metavar="DIR")
    parser.add_argument("--json", action="store_true", help="print everything as JSON")
    parser.set_defaults(main=main)


def main(args: argparse.Namespace) -> int:
    """Print the verdict; 0 dressed and not harmed, 1 not.

    Raises:
        RecordError: the record cannot be read.
    """
    from ...sim.evaluate.verdict import evaluate

    verdict = evaluate(args.directory)
    print(json.dumps(verdict.as_dict(), indent=1) if args.json else verdict)
    return 0 if verdict.dressed else 1
