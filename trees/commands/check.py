"""`caretree check`: proof before motion."""

from __future__ import annotations

import argparse

from ..check import check
from ..tasks import load_task


def main(options: argparse.Namespace) -> int:
    """Check the task; 0 when it holds, else 1.

    Raises:
        CaretreeError: the task is unknown or broken.
    """
    report = check(load_task(options.task))
    for finding in report.findings:
        print(f"fault: {finding}")
    for note in report.notes:
        print(f"note: {note}")
    followed = f"{report.skills} skills, {report.situations} situations in {report.executions} executions with stubs"
    if report.ok:
        print(f"{options.task} holds: every input is written before it is read, every failure ends safely ({followed})")
        return 0
    print(f"{options.task} does not hold: {len(report.findings)} faults ({followed})")
    return 1
