"""`caretree evaluate DIR`: did the run reach its goal?  Decided from the recorded truth alone.

A task's own judge is asked where the task has one; else whether the person is dressed, and unharmed.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from ...sim.record.record import read_run
from ..campaign.key import SOURCES
from ..campaign.recorded_task import FILE, recorded_task
from ..run.task import Task, TaskError


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the command line; `main` runs it."""
    parser = subparsers.add_parser(
        "evaluate",
        help="say from the record alone whether the run reached its goal",
        description="Decide from DIR/truth.npz alone what the task's own judge decides, or, where it has none, whether "
        "the person is dressed and, where the record tells, unharmed.  Exit status 0: yes, 1: no, 2: the record "
        "cannot be read.",
    )
    parser.add_argument("directory", type=Path, metavar="DIR", help="folder of the record, with run.json in it")
    parser.add_argument("--json", action="store_true", help="print everything as JSON")
    parser.set_defaults(main=main)


def main(args: argparse.Namespace) -> int:
    """Print the verdict; 0 goal reached (dressed and not harmed), 1 not.

    Raises:
        CaretreeError: the record cannot be read, or the task's own judge fails.
    """
    from ...sim.evaluate.verdict import evaluate

    task = _with_judge(args.directory)
    if task is not None:
        judgement = task.judged(args.directory)
        print(json.dumps(judgement.as_dict(), indent=1) if args.json else judgement)
        return 0 if judgement.success else 1
    verdict = evaluate(args.directory)
    print(json.dumps(verdict.as_dict(), indent=1) if args.json else verdict)
    return 0 if verdict.dressed else 1


def _with_judge(directory: Path) -> Task | None:
    """The task of the record, if it has a judge of its own; None for one of a name that is not known here.

    Raises:
        CaretreeError: the record cannot be read, or the file of its task is not there or broken.
    """
    run = read_run(directory)
    name, given = str(run.get("task")), run.get("parameters")
    parameters = given if isinstance(given, dict) else {}
    try:
        task, changed = recorded_task(name, parameters)
    except TaskError as error:
        if FILE in parameters or Path(name).suffix in SOURCES:
            raise TaskError(f"{error}; what judges {directory} stands in it") from None
        return None
    if changed:
        print(f"caretree: {changed}: the record is judged by what stands there now", file=sys.stderr)
    return task if task.judge is not None else None
