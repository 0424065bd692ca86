"""How far two campaigns agree, seed by seed: `python benchmarks/paired_engines.py DIR DIR`.

Such as `caretree trials undress --seeds 104-123 --out DIR` and the same with `--engine spring` leave them.  Prints how
often both came to the same outcome and were judged alike, and how far what the judge measured lies apart.
"""

import csv
import sys
from pathlib import Path

import numpy as np
from caretree.trees.campaign.success_rate import SuccessRate

GOOD = ("reached", "dressed")  # of the judge; a task has one of them


def rows_of(folder: str) -> dict[int, dict[str, str]]:
    """Each seed's row of a campaign."""
    with (Path(folder) / "trials.csv").open(newline="") as file:
        return {int(row["seed"]): row for row in csv.DictReader(file) if row["kind"] == "overall"}


one, other = (rows_of(folder) for folder in sys.argv[1:3])
pairs = [(one[seed], other[seed]) for seed in sorted(one.keys() & other.keys())]
print(f"{len(pairs)} pairs")
for name in ("outcome", *(name for name in GOOD if pairs[0][0][name])):
    alike = SuccessRate(successes=sum(a[name] == b[name] for a, b in pairs), trials=len(pairs))
    print(f"{name} alike: {alike}")
    for way in sorted({(a[name], b[name]) for a, b in pairs}):
        print(f"    {' and '.join(way)}: {[int(a['seed']) for a, b in pairs if (a[name], b[name]) == way]}")
numbers = list(pairs[0][0])[list(pairs[0][0]).index("sim_time_s") :]
for name in numbers:
    try:
        apart = np.array([float(b[name]) - float(a[name]) for a, b in pairs if a[name] and b[name]])
    except ValueError:
        continue  # of words
    if len(apart):
        print(f"{name}: apart by {apart.mean():+.4g} on average, {np.abs(apart).max():.4g} at most, in {len(apart)}")
