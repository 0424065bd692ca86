"""What `caretree gap` makes of records of runs in which one effect is hidden: `python benchmarks/dressing_gap.py OUT`.

Of each effect two sizes, three sets each, and ten sets without any.  A set is three runs of `wash_arm` (right arm, left
arm, and the first one's again on another seed, held out) in a world with the effect; the workflow sees their records
alone.  Seeds go round from `--first` on, over a hundred.  What is there is not done again.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from caretree.learning.gap.bench.score import judge_case, side_by_side
from caretree.learning.gap.dressing.loads import CHANNELS
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study
from caretree.sim.effects.dressing.dressing_registry import DRESSING_EFFECTS
from caretree.sim.effects.model_file import save_model
from caretree.sim.errors import CaretreeError

SIZES = (1.0, 2.0)  # typical sizes
SETS, EMPTY = 3, 10  # of each size; without any effect
RUNS = (("right", "fit"), ("left", "fit"), ("right", "heldout"))
SEEDS = 100  # that go round
LEAST, MOST = 0.8, 1.2  # of its size, an effect is drawn from


@dataclass(frozen=True)
class Case:
    """One set: what is hidden in it, which seed its first run has."""

    name: str
    seed: int
    effect: dict[str, Any] | None
    size: float

    @property
    def truth(self) -> dict[str, Any]:
        """As the benchmark of the other systems has it."""
        hidden = []
        if self.effect:
            values, target = self.effect["parameters"], self.effect["target"]
            values = {f"{target}_{p}": x for p, x in values.items()} if len(values) > 1 else values
            hidden = [{**self.effect, "size": self.size, "values": values}]
        kind = "single" if hidden else "none"
        return {"system": "dressing", "seed": self.seed, "kind": kind, "effects": hidden, "intervals": []}


def cases(first: int) -> Iterator[Case]:
    """All of them, with seeds of `first` to `first + 99`, in turn."""
    k = 0
    rng = np.random.default_rng(first)
    for name, effect in DRESSING_EFFECTS.items():
        if effect.on_cloth:
            continue
        for size in SIZES:
            for _ in range(SETS):
                target = str(rng.choice(effect.targets))
                values = {}
                for p in effect.parameters:
                    sign = rng.choice((-1.0, 1.0)) if p.lower < -MOST * size * p.typical else 1.0
                    values[p.name] = round(float(sign * size * p.typical * rng.uniform(LEAST, MOST)), 4)
                hidden = {"name": name, "target": target, "parameters": values}
                yield Case(f"{name}_{size:g}_{k:03d}", first + len(RUNS) * k % SEEDS, hidden, size)
                k += 1
    for _ in range(EMPTY):
        yield Case(f"none_{k:03d}", first + len(RUNS) * k % SEEDS, None, 0.0)
        k += 1


def record(case: Case, folder: Path) -> None:
    """The runs of a set, as a stranger would make them, and the set's file."""
    folder.mkdir(parents=True, exist_ok=True)
    model = ["--model", str(folder / "hidden.yaml")] if case.effect else []
    if case.effect:
        save_model(folder / "hidden.yaml", {"system": "dressing", "effects": [case.effect]})
    seed, episodes = case.seed, []
    for k, (side, role) in enumerate(RUNS):
        run = folder / f"run{k}"
        run_one(run, seed, arm_of(case, side), model)
        episodes.append({"run": run.name, "role": role})
        seed += 1
    (folder / "measurement.yaml").write_text(yaml.safe_dump({"system": "dressing", "episodes": episodes}))


def arm_of(case: Case, side: str) -> str:
    """Which arm is lifted: always the one whose hand's sensor is wrong, where one is."""
    target = case.effect["target"] if case.effect else ""
    return {"left_hand": "right", "right_hand": "left"}.get(target, side)


def run_one(run: Path, seed: int, side: str, model: list[str]) -> None:
    """One run of `wash_arm`, unless it is there."""
    if (run / "run.json").is_file():
        return
    asked = ["--seed", str(seed), "--set", f"arm={side}", "--set", "seconds=5", "--video", "off", "--out", str(run)]
    subprocess.run(
        [sys.executable, "-m", "caretree.trees.cli", "run", "wash_arm", *asked, *model], stdout=subprocess.DEVNULL
    )


def solve(case: Case, out: Path) -> dict[str, Any]:
    """The scored row of one case."""
    file = out / "rows" / f"{case.name}.json"
    if file.is_file():
        return json.loads(file.read_text())
    record(case, out / "sets" / case.name)
    began = time.process_time()
    try:
        study = open_study(load_set(out / "sets" / case.name), cache=out / "cache" / case.name)
        verdict = study.conclude().as_dict()
    except CaretreeError as error:
        return {"name": case.name, "error": str(error)}
    verdict["seconds"] = time.process_time() - began
    row = judge_case(case.truth, verdict) | {"name": case.name, "gap": verdict["gap"]}
    file.parent.mkdir(exist_ok=True)
    file.write_text(json.dumps(row))
    return row


def _load_gap(gap: dict[str, Any]) -> tuple[float, float]:
    """Before and after, of the load alone, over its floor, root mean square."""
    over = np.array(
        [[gap["channels"][c][k] / gap["channels"][c]["floor"] for k in ("before", "after")] for c in CHANNELS]
    )
    before, after = np.sqrt(np.mean(over**2, axis=0))
    return float(before), float(after)


def _end(x: float | None) -> str:
    return "none" if x is None else f"{x:.3f}"


def main() -> None:
    """Solve the cases asked for and print what came of them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--first", type=int, default=200, help="seed of the first run")
    parser.add_argument("--only", default="", help="cases whose names begin so")
    parser.add_argument("--part", default="0/1", help="K/N: every Nth case from the Kth on, for N processes")
    args = parser.parse_args()
    part, parts = (int(x) for x in args.part.split("/"))
    rows = []
    for case in [c for c in cases(args.first) if c.name.startswith(args.only)][part::parts]:
        row = solve(case, args.out)
        if "error" in row:
            print(f"{case.name}: {row['error']}", flush=True)
            continue
        rows.append(row)
        said = ", ".join(f"{n} on {t}" for n, t in row["said"]) or "nothing"
        held = "; ".join(
            f"{i['parameter']} {i['truth']:g}: {i['value']:.3f} ({_end(i['low'])} to {_end(i['high'])})"
            for i in row["intervals"]
        )
        before, after = _load_gap(row["gap"])
        closed = f"load's gap {before:.2f} to {after:.2f} of its floor"
        print(f"{case.name}: {row['verdict']}, {said}; {held}; {closed}, {row['seconds']:.0f} s", flush=True)
    print("\n".join(side_by_side([rows])))


if __name__ == "__main__":
    main()
