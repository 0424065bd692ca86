"""Processor time of scripted trials, with what forks them: `python benchmarks/scripted_trials.py [TASK [N]]`."""

import os
import sys
import tempfile
import time
from multiprocessing import forkserver
from pathlib import Path

from caretree.trees.campaign.trials import Plan, run_trials

TASK = sys.argv[1] if len(sys.argv) > 1 else "wave"
NUMBER = int(sys.argv[2]) if len(sys.argv) > 2 else 20


def forking() -> tuple[float, float]:
    """Processor time [s] of the process that forks, and of its runs that have ended."""
    fields = Path(f"/proc/{forkserver._forkserver._forkserver_pid}/stat").read_text().rpartition(")")[2].split()
    own, runs = (sum(int(field) for field in fields[n : n + 2]) / os.sysconf("SC_CLK_TCK") for n in (11, 13))
    return own, runs


if __name__ == "__main__":
    began, wall = time.process_time(), time.perf_counter()
    with tempfile.TemporaryDirectory() as home:
        plan = Plan(task=TASK, seeds=tuple(range(NUMBER)), directory=Path(home), arguments=("--world", "scripted"))
        trials = run_trials(plan, lambda line: None)
    own = time.process_time() - began
    loading, runs = forking()
    assert len(trials) == NUMBER
    print(f"{NUMBER} trials of {TASK} in {time.perf_counter() - wall:.1f} s")
    print(f"processor time: {loading:.2f} s to load once, then {(own + runs) / NUMBER:.3f} s a trial")
