"""What a log costs: share of a run's processor time that writing it takes.

python benchmarks/log_cost.py [TASK] [WORLD] [SEED] [HZ]
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path

from caretree.sim.log.log_file import LogFile
from caretree.sim.log.logged_world import logged
from caretree.sim.log.messages import Message
from caretree.trees.run.runner import run
from caretree.trees.run.task import load_task
from caretree.trees.run.worlds import make_world


class TimedFile(LogFile):
    """Counts the processor time of writing, of making the messages too [s]."""

    seconds = 0.0

    def write(self, time_: float, messages: Iterable[Message], *, at_once: bool = False) -> None:
        """Append messages."""
        began = time.process_time()
        super().write(time_, messages, at_once=at_once)
        self.seconds += time.process_time() - began

    def close(self) -> None:
        """Finish the file."""
        began = time.process_time()
        super().close()
        self.seconds += time.process_time() - began


def main(task: str = "wave", world: str = "scripted", seed: str = "0", hertz: str = "") -> None:
    """Run the task once with a log."""
    loaded = load_task(task)
    inner, senses = make_world(world, loaded, seed=int(seed))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.mcap"
        file = TimedFile(path)
        began = time.process_time()
        result = run(loaded, logged(inner, file, float(hertz) if hertz else None), seed=int(seed), senses=senses)
        file.close()
        spent = time.process_time() - began
        inner.close()
        share = 100.0 * file.seconds / (spent - file.seconds)
        print(
            f"{task} on {world}, seed {seed}: {result.outcome} after {result.sim_time_s:.1f} s; run without the log "
            f"{spent - file.seconds:.2f} s of processor time, log {file.seconds:.3f} s = {share:.1f} %, "
            f"{path.stat().st_size / 1e6:.1f} MB"
        )


if __name__ == "__main__":
    main(*sys.argv[1:])
