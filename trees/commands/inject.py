"""`caretree inject`: the fault campaign; finished rows are kept and not run again."""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TextIO

import numpy as np

from ...sim.command_line import INTERRUPTED
from ...sim.errors import CaretreeError
from ...sim.faults import FAULTS
from ...sim.record.file_lock import lock_file
from ...sim.record.spool import disk_error
from ...sim.world_kind import WorldKind
from ..campaign.fault_row import SIGNS, FaultKey, Row, table
from ..campaign.heat_map import write_heat_map
from ..campaign.inject import Campaign
from ..campaign.key import campaign_key
from ..campaign.run_maker import RunRecipe
from ..proof.check import refuse_faulty
from ..run.stop_signals import StopSignals
from ..run.task import Task, load_task
from ..run.worlds import read_world_arguments

ROWS = "inject.jsonl"


def main(options: argparse.Namespace) -> int:
    """Run the campaign; 0 when the task succeeds without a fault and survives all that were reached, at least one.

    Raises:
        CaretreeError: bad input, or the rows cannot be kept.
    """
    task = load_task(options.task, robot=options.robot)
    for fault in options.fault:
        if fault not in FAULTS:
            raise CaretreeError(f"unknown fault {fault!r}; there are {', '.join(FAULTS)}")
    refuse_faulty(task, options.stage)
    kind = WorldKind.named(options.world_kind)
    read_world_arguments(options.world, options.world_arg)
    parts = [re.sub(r"[^\w.-]+", "_", part) for part in (options.world, options.robot) if part]
    world = "-".join((*parts, *kind.difficulties))
    name = "-".join((Path(options.task).stem, *([options.stage] if options.stage else []), world))
    usual = Path("runs") / f"inject-{name}-seed{options.seed}"
    path = Path(options.out or usual) / ROWS
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        lock = lock_file(path)
    except OSError as error:
        raise disk_error(error, f"writing {path}") from error
    if lock is None:
        raise CaretreeError(f"another campaign is writing {path}: give another folder with --out or wait for it")
    try:
        with StopSignals():
            return _campaign(options, task, path)
    finally:
        os.close(lock)


def _campaign(options: argparse.Namespace, task: Task, path: Path) -> int:
    recipe = RunRecipe(
        task=options.task,
        robot=options.robot,
        world=options.world,
        world_kind=options.world_kind,
        world_arguments=tuple(options.world_arg),
        seed=options.seed,
        stage=options.stage,
        senses=options.senses,
    )
    campaign = Campaign(
        task,
        recipe.worlds(task),
        seed=options.seed,
        faults=tuple(options.fault) or FAULTS,
        stage=options.stage,
        jobs=options.jobs,
        address=options.address,
        recipe=recipe,
    )
    if campaign.nominal.outcome != "success":
        print(f"without any fault the task already ends in {campaign.nominal.outcome}: {campaign.nominal.reason}")
    if campaign.left_out:
        print(f"left out, as they happen in physics and this world does not play them: {', '.join(campaign.left_out)}")
    wanted = drawn_rows(campaign.plan(), options.sample, options.seed)
    given = (options.world, options.world_kind, str(options.seed), str(options.stage), *options.world_arg)
    given += () if options.robot is None else (options.robot,)
    given += () if options.senses == "own" else (options.senses,)
    key = campaign_key(task, given, world=options.world)
    rows = _kept(path, key, wanted)
    print(f"{len(wanted)} faults to try, {len(rows)} of them tried before", flush=True)
    try:
        done = {row.key for row in rows}
        missing = campaign.rows([key for key in wanted if key not in done])
        with _opened(path) as file, contextlib.closing(missing):
            for row in missing:
                _keep(file, row, key)
                rows.append(row)
                if how := _ending(row):
                    told = f"{row.fault}@{row.node}:{row.phase}: {how}"
                    print(f"[{len(rows)}/{len(wanted)}] {told}", flush=True)
    except KeyboardInterrupt:
        kept = _kept(path, key, wanted)  # the file's word: a row may be in it and not among `rows` yet
        print(f"interrupted; {len(kept)} of {len(wanted)} rows are kept in {path}, run it again to go on")
        return INTERRUPTED
    rows.sort(key=lambda row: wanted.index(row.key))
    print(table(rows))
    print(write_heat_map(path.parent, f"{options.task}, faults, seed {options.seed}", rows))
    tried = [row for row in rows if row.outcome != "not_reached"]
    if len(tried) < len(rows):
        print(f"{len(rows) - len(tried)} of {len(rows)} were not reached: nothing is said of them")
    if len(rows) < len(wanted):
        print(
            f"{len(wanted) - len(rows)} were lost with the process that tried them: the same command tries them again"
        )
        return 1
    if not tried:
        print("none was reached: give more rows with --sample, or another --seed")
    return 0 if campaign.nominal.outcome == "success" and tried and all(row.survived for row in tried) else 1


def _opened(path: Path) -> TextIO:
    try:
        return path.open("a", encoding="utf-8")
    except OSError as error:
        raise disk_error(error, f"writing {path}") from error


def _keep(file: TextIO, row: Row, key: str) -> None:
    """Write a row, at once; that nobody reads what is printed of it is another matter."""
    try:
        file.write(json.dumps(row.as_dict() | {"key": key}) + "\n")
        file.flush()
    except OSError as error:
        raise disk_error(error, f"writing {file.name}") from error


def _kept(path: Path, key: str, wanted: Sequence[FaultKey]) -> list[Row]:
    """The rows of this campaign that the file already holds."""
    asked = set(wanted)
    return [row for row in read_rows(path, key) if row.key in asked]


def _ending(row: Row) -> str:
    """How a row ended, in words; empty for one that was not reached and says nothing more."""
    if row.unsafe or row.outcome != "not_reached":
        return row.unsafe or row.outcome
    return f"not reached: {row.reason}" if row.reason else ""


def drawn_rows(plan: list[FaultKey], count: int | None, seed: int) -> list[FaultKey]:
    """`count` rows of a campaign too long to run whole, drawn by the seed, in the plan's order; None takes all.

    Raises:
        CaretreeError: `count` is below 1.
    """
    if count is None or count >= len(plan):
        return plan
    if count < 1:
        raise CaretreeError(f"--sample is {count}, but at least 1 fault is asked for")
    chosen = np.random.default_rng(seed).choice(len(plan), count, replace=False)
    return [plan[k] for k in sorted(chosen)]


def read_rows(path: Path, key: str) -> list[Row]:
    """Rows of an earlier, perhaps interrupted campaign; one that is damaged or of another key is tried again."""
    if not path.exists():
        return []
    rows = []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        try:
            stored = json.loads(line)
            if stored.pop("key", None) != key:
                continue
            row = Row(**stored)
            texts = {key: value for key, value in row.as_dict().items() if key != "time_to_safe"}
            timed = row.time_to_safe is None or type(row.time_to_safe) in (int, float)
            if row.outcome in SIGNS and timed and all(isinstance(text, str) for text in texts.values()):
                rows.append(row)
        except (ValueError, TypeError, AttributeError, RecursionError):
            continue
    return rows
