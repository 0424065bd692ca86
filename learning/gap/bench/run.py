"""Run the benchmark: generate, hand each set to the workflow, score against the truth opened afterwards."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from contextlib import nullcontext
from functools import cache
from itertools import repeat
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from ..errors import GapError
from .score import Row, judge_case, side_by_side

SYSTEMS = ("arm", "axis", "fall", "cloth", "payload", "placement")


@cache
def _apart() -> ProcessPoolExecutor:
    """The process that alone knows what is hidden: it writes the sets and performs the experiments asked for."""
    return ProcessPoolExecutor(1, mp_context=get_context("spawn"))


def solve(system: str, seed: int, out: Path, again: bool = False) -> list[Path]:
    """Generate and solve one case; a finished one is not done again.

    Args:
        system: of the case.
        seed: of the case.
        out: folder of the benchmark.
        again: also perform the experiment the verdict asks for, and solve the set with it.

    Returns:
        The files with its scored rows, one per round.
    """
    from .generate import generate, perform

    name = f"{system}_{seed:05d}"
    first, second = out / "rows" / f"{name}.json", out / "rows" / f"{name}_again.json"
    if not first.is_file():
        _apart().submit(generate, system, seed, out).result()
        _row(out, name, first, _verdict(out, name))
    if not again:
        return [first]
    if not second.is_file():
        asked = json.loads(first.read_text())["follow_up"]
        if asked:
            _apart().submit(perform, seed, asked, out).result()
            _row(out, name, second, _verdict(out, f"{name}_again"))
        else:
            second.write_text(first.read_text())
    return [first, second]


def _verdict(out: Path, name: str) -> dict[str, Any]:
    from ..measurement import load_set
    from ..open_study import open_study

    started = time.monotonic()
    study = open_study(load_set(out / "sets" / name), cache=out / "cache" / name)
    return {**study.conclude().as_dict(), "seconds": time.monotonic() - started}


def _row(out: Path, name: str, file: Path, verdict: dict[str, Any]) -> None:
    truth = json.loads((out / "truth" / f"{name}.json").read_text())
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps({**judge_case(truth, verdict), "follow_up": verdict["follow_up"]}))


def run(
    systems: list[str],
    seeds: str,
    half: str,
    out: Path,
    ablations: bool,
    jobs: int,
    say: Callable[[str], None],
    observer: bool = False,
    again: bool = False,
) -> int:
    """Score seeds first:last of every system and print the table.

    Args:
        systems: among arm, axis, fall, cloth, payload, placement.
        seeds: `first:last`.
        half: `tune` (even seeds), `report` (odd) or `both`.
        out: folder for sets, truths, rows and the table; what is there is not done again.
        ablations: also score simpler ways on the same sets.
        jobs: processes.
        say: told of every case.
        observer: also say what could be known from the drops at most.
        again: of drops, perform the experiment each verdict asks for, solve the set with it, and score both rounds.

    Raises:
        GapError: seeds or systems make no sense.
    """
    wanted = _wanted(seeds, half)
    cases = [(system, seed) for system in _known(systems) for seed in wanted]
    if again and systems != ["fall"]:
        raise GapError("--follow-up is for --system fall alone, no other system's verdict asks for a recording")
    out.mkdir(parents=True, exist_ok=True)
    rounds: list[list[Row]] = [[], []] if again else [[]]
    with ProcessPoolExecutor(jobs) if jobs > 1 else nullcontext() as pool:
        solved = (pool.map if pool else map)(solve, *zip(*cases, strict=True), repeat(out), repeat(again))
        for k, files in enumerate(solved):
            for rows, file in zip(rounds, files, strict=True):
                rows.append(json.loads(file.read_text()))
            say(f"{k + 1}/{len(cases)} {' ; '.join(_line(rows[-1]) for rows in rounds)}")
    lines = side_by_side(rounds)
    if ablations:
        from .ablations import compare

        lines += compare(cases, out, say)
    if observer and "fall" in systems:
        from .fall_observer import report

        lines += report(wanted, out, say)
    (out / f"table_{half}.txt").write_text("\n".join(lines) + "\n")
    say("\n".join(lines))
    return 0


def _known(systems: list[str]) -> list[str]:
    for system in systems:
        if system not in SYSTEMS:
            raise GapError(f"--system has '{system}', it must be among {', '.join(SYSTEMS)}")
    return systems


def _wanted(seeds: str, half: str) -> list[int]:
    """Seeds of `first:last` in one half, or in both."""
    try:
        first, last = (int(x) for x in seeds.split(":"))
    except ValueError:
        raise GapError(f"--seeds is '{seeds}', it must look like 0:200") from None
    wanted = [s for s in range(first, last) if half == "both" or s % 2 == (0 if half == "tune" else 1)]
    if not wanted:
        raise GapError(f"--seeds {seeds} --half {half} holds no seed")
    return wanted


def _line(r: Row) -> str:
    hidden = ", ".join(f"{n} on {t}" for n, t in r["hidden"]) or "nothing"
    said = ", ".join(f"{n} on {t}" for n, t in r["said"]) or "-"
    return f"{r['system']} {r['seed']} {r['kind']}: {hidden} (size {r['size']:.1f}) => {r['verdict']}: {said}"
