"""What comes of a dressing that goes wrong half way: `python benchmarks/disasters.py OUT FIRST LAST [--jobs J]`.

Each row of `DISASTERS` is played in PyBullet, with the seeds from FIRST to LAST in turn; runs that are in OUT already
are not repeated.  Each is judged as `caretree evaluate` does.  From the rail a run takes about ten minutes; `--stage
dress-spread` begins with the gown laid on the person, and leaves rows of earlier stages out.
"""

import argparse
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from itertools import cycle
from pathlib import Path

from caretree.trees.campaign.success_rate import SuccessRate

BEFORE_THE_PERSON = ("rail/draw it aside:step", "gown/lay it on the person:step")
WHEN = (
    *BEFORE_THE_PERSON,
    "right arm/lift:step",
    "right arm/pull over the hand:step",
    "left arm/grasp the sleeve:step",
    "left arm/pull up:step",
    "gown/sleeves/seat:step",
    "gown/then/spread:step",
)
FAULTS = ("grip_slip", "person_moves", "camera_out")
# every place once before any of them twice, each time with another fault
DISASTERS = tuple(
    f"{FAULTS[(n + turn) % len(FAULTS)]}@{when}" for turn in range(len(FAULTS)) for n, when in enumerate(WHEN)
)


def played(out: Path, seed: int, disaster: str, stage: str | None) -> dict[str, object]:
    """What came of one run."""
    folder = out / f"{seed}-{disaster.replace('/', '_').replace('@', '-').replace(':', '-').replace(' ', '_')}"
    caretree = (sys.executable, "-m", "caretree")
    if not (folder / "run.json").exists():
        begin = ("--stage", stage) if stage else ()
        command = (*caretree, "run", "dressing", "--seed", str(seed), "--inject", disaster, *begin)
        with (out / f"{folder.name}.log").open("w") as log:
            subprocess.run((*command, "--video", "off", "--out", folder), stdout=log, stderr=log, check=False)
    run = json.loads((folder / "run.json").read_text())
    judged = subprocess.run((*caretree, "evaluate", folder, "--json"), capture_output=True, text=True, check=False)
    verdict = json.loads(judged.stdout)
    return {
        "seed": seed,
        "disaster": disaster,
        "happened": bool(run.get("faults")),
        "dressed": verdict["dressed"],
        "unharmed": verdict["unharmed"],
        "outcome": run["outcome"],
        "reason": run.get("reason", ""),
    }


parser = argparse.ArgumentParser(description="dressing runs in which something goes wrong")
parser.add_argument("out", type=Path)
parser.add_argument("first", type=int)
parser.add_argument("last", type=int)
parser.add_argument("--jobs", type=int, default=1)
parser.add_argument("--stage")
given = parser.parse_args()
given.out.mkdir(parents=True, exist_ok=True)
rows = [row for row in DISASTERS if given.stage is None or row.split("@")[1] not in BEFORE_THE_PERSON]
seeds = cycle(range(given.first, given.last + 1))
with ThreadPoolExecutor(given.jobs) as pool:
    found = list(pool.map(lambda job: played(given.out, *job, given.stage), zip(seeds, rows, strict=False)))
for row in found:
    print(json.dumps(row))
for what in ("dressed", "unharmed"):
    print(f"{what}: {SuccessRate(successes=sum(bool(row[what]) for row in found), trials=len(found))}")
