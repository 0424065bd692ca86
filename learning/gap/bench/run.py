"""Run the benchmark: generate, hand each set to the workflow, score against the truth opened afterwards."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from ..errors import GapError
from .score import judge_case, table


def solve(system: str, seed: int, out: Path) -> Path:
    """Generate and solve one case; a finished one is not done again.

    Returns:
        The file with its scored row.
    """
    from ..measurement import load_set
    from ..study import open_study
    from .generate import generate

    result = out / "rows" / f"{system}_{seed:05d}.json"
    if result.is_file():
        return result
    generate(system, seed, out)
    name = f"{system}_{seed:05d}"
    started = time.monotonic()
    study = open_study(load_set(out / "sets" / name), cache=out / "cache" / name)
    verdict = study.conclude().as_dict()
    verdict["seconds"] = time.monotonic() - started
    truth = json.loads((out / "truth" / f"{name}.json").read_text())
    result.parent.mkdir(parents=True, exist_ok=True)
    result.write_text(json.dumps(judge_case(truth, verdict)))
    return result


def run(
    systems: list[str],
    seeds: str,
    half: str,
    out: Path,
    ablations: bool,
    jobs: int,
    say: Callable[[str], None],
    observer: bool = False,
) -> int:
    """Score seeds first:last of every system and print the table.

    Args:
        systems: among arm, axis, fall, cloth.
        seeds: `first:last`.
        half: `tune` (even seeds), `report` (odd) or `both`.
        out: folder for sets, truths, rows and the table; what is there is not done again.
        ablations: also score simpler ways on the same sets.
        jobs: processes.
        say: told of every case.
        observer: also say what could be known from the drops at most.

    Raises:
        GapError: seeds or systems make no sense.
    """
    try:
        first, last = (int(x) for x in seeds.split(":"))
    except ValueError:
        raise GapError(f"--seeds is '{seeds}', it must look like 0:200") from None
    for system in systems:
        if system not in ("arm", "axis", "fall", "cloth"):
            raise GapError(f"--system has '{system}', it must be among arm, axis, fall, cloth")
    wanted = [s for s in range(first, last) if half == "both" or s % 2 == (0 if half == "tune" else 1)]
    cases = [(system, seed) for system in systems for seed in wanted]
    if not cases:
        raise GapError(f"--seeds {seeds} --half {half} holds no seed")
    out.mkdir(parents=True, exist_ok=True)
    rows = []
    if jobs > 1:
        with ProcessPoolExecutor(jobs) as pool:
            for k, file in enumerate(pool.map(solve, *zip(*cases, strict=True), [out] * len(cases))):
                rows.append(json.loads(file.read_text()))
                say(f"{k + 1}/{len(cases)} {_line(rows[-1])}")
    else:
        for k, (system, seed) in enumerate(cases):
            rows.append(json.loads(solve(system, seed, out).read_text()))
            say(f"{k + 1}/{len(cases)} {_line(rows[-1])}")
    lines = [f"{'question':52s} {'system':6s} {'right':>9s}  rate (95 % interval)"]
    lines += [f"{q:52s} {s:6s} {h:4d}/{n:4d}  {r:.3f} ({a:.3f} to {b:.3f})" for q, s, h, n, r, a, b in table(rows)]
    if ablations:
        from .ablations import compare

        lines += compare(cases, out, say)
    if observer and "fall" in systems:
        from .fall_observer import report

        lines += report(wanted, out, say)
    (out / f"table_{half}.txt").write_text("\n".join(lines) + "\n")
    say("\n".join(lines))
    return 0


def _line(r: dict) -> str:
    hidden = ", ".join(f"{n} on {t}" for n, t in r["hidden"]) or "nothing"
    said = ", ".join(f"{n} on {t}" for n, t in r["said"]) or "-"
    return f"{r['system']} {r['seed']} {r['kind']}: {hidden} (size {r['size']:.1f}) => {r['verdict']}: {said}"
