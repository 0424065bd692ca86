"""What `caretree gap` makes of records of runs in which one effect is hidden: `python benchmarks/dressing_gap.py OUT`.

Of each effect two sizes, three sets each, and ten sets without any; the last of three runs is held out.  A set is three
runs of `wash_arm` (right arm, left arm, right arm) in a world with the effect, or, where it shows only as a hand holds
the gown, three of `dressing --stage dress` until a sleeve is over its hand.  The workflow sees their records alone.
Seeds go round from `--first` on, over a hundred.  What is there is not done again.
"""

from __future__ import annotations

import argparse
import json
import shutil
import signal
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
from caretree.sim.errors import CaretreeError, RecordError
from caretree.sim.record.recorded_stretch import read_stretch
from caretree.skills.geometry.stances import PULLING

SIZES = (0.75, 1.5)  # typical sizes; twice that of friction, and no hand lifts the arm within 30 N
SETS, EMPTY = 3, 10  # of each size; without any effect
RUNS = (("right", "fit"), ("left", "fit"), ("right", "heldout"))
SEEDS = 100  # that go round
RUN = (sys.executable, "-u", "-m", "caretree.trees.cli", "run")
GRASP, PULL = "grasp the sleeve", "pull over the hand"  # names of leaves
BEYOND = 1.5  # before a pull ends the hand touches the person's own, which is not compared [s]
FRICTIONS = ("joint_friction", "sleeve_friction")
LEAST, MOST = 0.8, 1.2  # of its size, an effect is drawn from


@dataclass(frozen=True)
class Case:
    """One set: what is hidden in it, which seed its first run has."""

    name: str
    seed: int
    effect: dict[str, Any] | None
    size: float
    sleeve: bool = False  # recorded as a sleeve is pulled, not as an arm is lifted

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
        for size in SIZES:
            for _ in range(SETS):
                target = str(rng.choice(effect.targets))
                values = {}
                for p in effect.parameters:
                    sign = rng.choice((-1.0, 1.0)) if p.lower < -MOST * size * p.typical else 1.0
                    values[p.name] = round(float(sign * size * p.typical * rng.uniform(LEAST, MOST)), 4)
                hidden = {"name": name, "target": target, "parameters": values}
                yield Case(f"{name}_{size:g}_{k:03d}", first + len(RUNS) * k % SEEDS, hidden, size, effect.on_cloth)
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
        if case.sleeve:
            span = pull_sleeve(run, seed, model)
            while not span:  # as one does who wants a record: another bed, another try
                shutil.rmtree(run)
                seed += len(RUNS)
                span = pull_sleeve(run, seed, model)
            episodes.append({"run": run.name, "role": role, **span})
        else:
            while not lift(run, seed, arm_of(case, side), model):
                shutil.rmtree(run)
                seed += len(RUNS)
            episodes.append({"run": run.name, "role": role})
        seed += 1
    (folder / "measurement.yaml").write_text(yaml.safe_dump({"system": "dressing", "episodes": episodes}))


def arm_of(case: Case, side: str) -> str:
    """Which arm is lifted: always the one whose hand's sensor is wrong, where one is."""
    target = case.effect["target"] if case.effect else ""
    return {"left_hand": "right", "right_hand": "left"}.get(target, side)


def pull_sleeve(run: Path, seed: int, model: list[str]) -> dict[str, Any]:
    """When which hand pulled a sleeve over the person's own, recorded unless it is there; {} where none came so far."""
    if not (run / "run.json").is_file():
        shutil.rmtree(run, ignore_errors=True)  # of a run that was cut short
        asked = ["dressing", "--stage", "dress", "--seed", str(seed), "--video", "off", "--out", str(run)]
        with subprocess.Popen([*RUN, *asked, *model], stdout=subprocess.PIPE, text=True) as running:
            assert running.stdout is not None
            for line in running.stdout:
                if " + " in line and PULL in line:
                    running.send_signal(signal.SIGTERM)  # the arm is put down, and the record kept
    ended: dict[str, float] = {}
    for line in (run / "trace.jsonl").read_text().splitlines():
        event = json.loads(line)
        node = event.get("node", "").rpartition("/")
        arm = node[0].rpartition("/")[2]
        if event.get("status") == "SUCCESS" and arm.endswith(" arm"):
            ended[f"{arm}/{node[2]}"] = event["t"]
            if node[2] == PULL:
                t0, t1 = ended[f"{arm}/{GRASP}"] + 0.2, event["t"] - BEYOND
                return {"t0": t0, "t1": t1, "hand": PULLING[arm.removesuffix(" arm")]}
    return {}


def lift(run: Path, seed: int, side: str, model: list[str]) -> bool:
    """One run of `wash_arm`, unless it is there; tells whether an arm was lifted in it."""
    if (run / "run.json").is_file():
        return _usable(run)
    shutil.rmtree(run, ignore_errors=True)
    asked = ["wash_arm", "--seed", str(seed), "--set", f"arm={side}", "--set", "seconds=5", "--video", "off"]
    subprocess.run([*RUN, *asked, "--out", str(run), *model], stdout=subprocess.DEVNULL)
    return _usable(run)


def _usable(run: Path) -> bool:
    """Whether `gap` takes it for a set."""
    try:
        read_stretch(run)
    except RecordError:
        return False
    return True


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
        verdict = {"verdict": "unknown", "effects": [], "where": [], "gap": {}, "error": str(error)}
    verdict["seconds"] = time.process_time() - began
    row = judge_case(case.truth, verdict) | {
        "name": case.name,
        "gap": verdict["gap"],
        "error": verdict.get("error", ""),
    }
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
        rows.append(row)
        if row["error"]:
            print(f"{case.name}: {row['error']}", flush=True)
            continue
        said = ", ".join(f"{n} on {t}" for n, t in row["said"]) or "nothing"
        held = "; ".join(
            f"{i['parameter']} {i['truth']:g}: {i['value']:.3f} ({_end(i['low'])} to {_end(i['high'])})"
            for i in row["intervals"]
        )
        before, after = _load_gap(row["gap"])
        closed = f"load's gap {before:.2f} to {after:.2f} of its floor"
        print(f"{case.name}: {row['verdict']}, {said}; {held}; {closed}, {row['seconds']:.0f} s", flush=True)
    print("\n".join([*side_by_side([rows]), *_in_short(rows)]))


def _in_short(rows: list[dict[str, Any]]) -> list[str]:
    """How much of the load's gap was closed, and how near frictions are."""
    closed = []
    for row in rows:
        if row["kind"] == "single" and row["gap"]:
            before, after = _load_gap(row["gap"])
            if before > 1.0:
                closed.append(min((before - after) / (before - 1.0), 1.0))
    off = [abs(i["value"] / i["truth"] - 1.0) for r in rows for i in r["intervals"] if i["effect"] in FRICTIONS]
    out = [f"the load's gap above its floor, closed: median {np.median(closed):.2f} of {len(closed)}"] if closed else []
    return [*out, f"frictions within 20 %: {sum(x <= 0.2 for x in off)} of {len(off)}"]


if __name__ == "__main__":
    main()
