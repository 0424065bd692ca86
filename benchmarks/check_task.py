"""Processor time of the two halves of `caretree check TASK`: `python benchmarks/check_task.py [TASK]`."""

import gc
import sys
import time

from caretree.trees.cli import MADE_UNTIL_LOOKED_THROUGH
from caretree.trees.proof.check import check, rehearse
from caretree.trees.run.task import load_task

gc.set_threshold(MADE_UNTIL_LOOKED_THROUGH)  # as for the command itself
task = load_task(sys.argv[1] if len(sys.argv) > 1 else "dressing")
began = time.process_time()
report = check(task)
proved = time.process_time()
each = (proved - began) / max(report.executions, 1)
print(f"proof: {proved - began:.2f} s, {report.executions} executions of {1e6 * each:.0f} us")
for run in ("first rehearsal", "second rehearsal"):  # the first one loads compiled code and the robot's model
    began = time.process_time()
    rehearse(task)
    print(f"{run}: {time.process_time() - began:.2f} s")
