"""`caretree check`: proof before motion."""

from __future__ import annotations

import argparse

from ..proof.check import check, fresh_tree, rehearse
from ..proof.draw import drawn
from ..run.task import load_task


def main(options: argparse.Namespace) -> int:
    """Check the task, or draw its tree; 0 when it holds, else 1.

    Raises:
        CaretreeError: the task is unknown or broken.
    """
    task = load_task(options.task, robot=options.robot)
    if options.tree:
        print("\n".join(drawn(fresh_tree(task))))
        return 0
    report = check(task)
    if report.ok:  # else it would only show once more what was found
        rehearsal = rehearse(task)
        report.findings += rehearsal.findings
        report.notes += rehearsal.notes
    for parameter in task.declared.values():
        print(f"parameter: {parameter.line()}")
    for finding in report.findings:
        print(f"fault: {finding}")
    for note in report.notes:
        print(f"note: {note}")
    followed = (
        f"{_count(report.skills, 'skill')}, {_count(report.situations, 'situation')} in "
        f"{_count(report.executions, 'execution')} with stubs"
    )
    if report.ok:
        print(f"{options.task} holds: every input is written before it is read, every failure ends safely ({followed})")
        return 0
    print(f"{options.task} does not hold: {_count(len(report.findings), 'fault')} ({followed})")
    return 1


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"
