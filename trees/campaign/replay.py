"""Runs a record again and says where the second run differs from the first."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...sim.errors import CaretreeError
from ...sim.faults import FaultyWorld, parse_fault
from ...sim.record.record import RUN_FILE, TRACE_FILE, read_finished_run, versions
from ...sim.world_kind import EASY
from ...skills.core.settings import Settings
from ..report.timeline import read_trace
from ..run.runner import Run
from ..run.task import load_task
from ..run.trace import canonical
from ..run.worlds import make_world, prepare_stage


@dataclass(frozen=True)
class Replay:
    """How a second run compares.

    Attributes:
        same: every event was the same.
        difference: where the first one differs, in one sentence.
        versions: packages of another version than then, as `name: then, now`.
    """

    same: bool
    difference: str = ""
    versions: list[str] = field(default_factory=list)


def replay(directory: Path) -> Replay:
    """Run the record in `directory` again, in memory.

    Raises:
        CaretreeError: the record is damaged or unfinished, or its task or world is not there.
        KeyboardInterrupt: the operator ended the second run.
    """
    record = read_finished_run(directory)
    try:
        task, seed, world_name = str(record["task"]), int(record["seed"]), str(record["world"])
        parameters: dict[str, Any] = dict(record.get("parameters") or {})
    except (KeyError, TypeError, ValueError) as error:
        raise CaretreeError(f"{directory / RUN_FILE} is damaged: task, seed and world are asked for") from error
    before = read_trace(directory / TRACE_FILE)
    loaded = load_task(task)
    inner, senses = make_world(
        world_name,
        loaded,
        seed=seed,
        gown=parameters.get("gown"),
        person=parameters.get("person"),
        model=parameters.get("model"),
        kind=parameters.get("world_kind", EASY),  # records from before there were kinds
    )
    stage = parameters.get("stage")
    faults = [parse_fault(text) for text in parameters.get("inject") or []]
    try:
        world = FaultyWorld(inner, faults) if faults else inner
        run = Run(
            loaded,
            world,
            seed=seed,
            rate_hz=float(parameters.get("rate_hz", 15.0)),
            senses=senses,
            params=loaded.parameters(stage),
            settings=Settings(parameters.get("tuning")),
        )
        prepare_stage(inner, loaded, stage)
        run.run()
        if run.interrupted:
            raise KeyboardInterrupt
    finally:
        inner.close()
    difference = first_difference(before, run.trace.events)
    now, then = versions(), record.get("versions") or {}
    changed = [
        f"{name}: {then[name]}, now {now[name]}" for name in sorted(now) if name in then and then[name] != now[name]
    ]
    return Replay(same=not difference, difference=difference, versions=changed)


def first_difference(before: list[dict[str, Any]], after: list[dict[str, Any]]) -> str:
    """Where two traces part, in one sentence; empty when they do not."""
    for number, (old, new) in enumerate(zip(before, after, strict=False), start=1):
        if canonical(old) != canonical(new):
            return f"event {number} differs: it was {_said(old)}, it is {_said(new)}"
    if len(before) != len(after):
        longer, which = (before, "recorded") if len(before) > len(after) else (after, "new")
        short = min(len(before), len(after))
        return f"the {which} trace goes on after event {short} with {_said(longer[short])}"
    return ""


def _said(event: Mapping[str, Any]) -> str:
    rest = {key: value for key, value in event.items() if key not in ("t", "kind", "detail")}
    return f"{event.get('kind')} at {event.get('t')} s {rest}"
