"""Where a recorded run's processor time went, against Bullet's own steps: `python benchmarks/whole_run.py DIR`.

Such as `caretree run dressing --stage lay --seed 3 --out DIR` leaves it.  Counts the thread that ticks and steps; what
the video takes beside it is told apart.
"""

import json
import sys
from pathlib import Path

run = json.loads((Path(sys.argv[1]) / "run.json").read_text())
parts = run["processor_timing"]
whole = sum(parts.values())
for part, seconds in sorted(parts.items(), key=lambda item: -item[1]):
    print(f"{part:8} {seconds:8.2f} s  {100 * seconds / whole:5.1f} %")
print(
    f"{run['sim_time_s']:.1f} s simulated in {whole:.2f} s of processor time, and {run['beside_time_s']:.2f} s beside"
)
print(f"whole / Bullet: {whole / parts['bullet']:.3f}    trace {run['trace_hash'][:12]}")
