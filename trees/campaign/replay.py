"""Runs a record again and says where the second run differs from the first."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...sim.faults import FaultyWorld, parse_fault
from ...sim.log.logged_world import logged
from ...sim.record.record import TRACE_FILE, versions
from ...skills.core.settings import Settings
from ..report.timeline import read_trace
from ..run.given_files import HASHES, changed_files
from ..run.perceptions import CLASSICAL, grasp_with, see_with
from ..run.recorded_start import read_start
from ..run.runner import Run
from ..run.trace import canonical
from ..run.worlds import closed_after, make_world, prepare_stage, senses_for
from .recorded import recorded
from .recorded_task import FILE, HASH, recorded_task


@dataclass(frozen=True)
class Replay:
    """How a second run compares.

    Attributes:
        same: every event was the same.
        difference: where the first one differs, in one sentence.
        versions: packages of another version than then, as `name: then, now`.
        changed: says that the task, or a file of its gown or model, is another one than then; empty where none is.
    """

    same: bool
    difference: str = ""
    versions: list[str] = field(default_factory=list)
    changed: str = ""


def replay(directory: Path) -> Replay:
    """Run the record in `directory` again, in memory.

    Raises:
        CaretreeError: the record is damaged or unfinished, or its task or world is not there.
        KeyboardInterrupt: the operator ended the second run.
    """
    given = recorded(directory)
    before = read_trace(directory / TRACE_FILE)
    loaded, changed = recorded_task(given.task, {FILE: given.task_file, HASH: given.task_hash}, robot=given.robot)
    files = changed_files({"gown": given.gown, "model": given.model, HASHES: given.file_hashes})
    faults = [parse_fault(text) for text in given.inject]
    inner, senses = make_world(
        given.world,
        loaded,
        seed=given.seed,
        gown=given.gown,
        person=given.person,
        model=given.model,
        kind=given.world_kind,
        look=given.look,
        engine=given.engine,
        arguments=given.world_args,
    )
    with closed_after(inner):
        senses = senses or senses_for(given.senses or "own", loaded, inner, given.seed)
        measured = inner if given.log_rate is None else logged(inner, None, given.log_rate)
        world = FaultyWorld(measured, faults) if faults else measured
        run = Run(
            loaded,
            world,
            seed=given.seed,
            rate_hz=given.rate_hz,
            settled_rate_hz=given.settled_rate_hz,
            senses=senses,
            params=loaded.values(given.build) | loaded.parameters(given.stage),
            settings=Settings(given.tuning),
        )
        see_with(run.context, given.perception or CLASSICAL)
        grasp_with(run.context, given.pregrasp or CLASSICAL)
        if given.start is None:
            prepare_stage(inner, loaded, given.stage)
        else:
            read_start(given.start).prepare(inner)
        run.run()
        if run.interrupted:
            raise KeyboardInterrupt
    difference = first_difference(before, run.trace.events)
    if not difference and given.trace_hash not in (None, run.trace.digest()):
        difference = f"every event is the same, but run.json says {given.trace_hash} of a trace of {run.trace.digest()}"
    now, then = versions(), given.versions
    others = [
        f"{name}: {then[name]}, now {now[name]}" for name in sorted(now) if name in then and then[name] != now[name]
    ]
    return Replay(
        same=not difference, difference=difference, versions=others, changed="; ".join(filter(None, (changed, files)))
    )


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
