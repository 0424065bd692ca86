"""`caretree trials`: many seeds, one table."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...sim.errors import CaretreeError
from ..tasks import load_task
from ..trials import TABLE, Plan, run_trials


def main(options: argparse.Namespace) -> int:
    """Run the campaign and print its table.

    Raises:
        CaretreeError: bad input, or the disk is full.
    """
    if options.address:
        raise CaretreeError(f"--address {options.address}: runs on other machines are not in this version; use --jobs")
    load_task(options.task)
    arguments = ["--world", options.world]
    for flag in ("gown", "person", "model"):
        if getattr(options, flag):
            arguments += [f"--{flag}", getattr(options, flag)]
    directory = Path(options.out or Path("runs") / f"trials-{Path(options.task).stem}")
    plan = Plan(task=options.task, seeds=tuple(range(options.seed, options.seed + options.number)), directory=directory,
                stage=options.stage, arguments=tuple(arguments), jobs=options.jobs)
    try:
        run_trials(plan, lambda line: print(line, flush=True))
    except KeyboardInterrupt:
        print(f"interrupted; finished trials are kept in {directory}, run it again to go on")
        return 130
    print((directory / TABLE).read_text(encoding="utf-8"), end="")
    return 0
