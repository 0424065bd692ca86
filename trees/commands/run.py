"""`caretree run`: one run, its progress, its record, its outcome in one sentence."""

from __future__ import annotations

import argparse
import itertools
import signal
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...sim.errors import CaretreeError
from ...sim.faults import FaultSpec, FaultyWorld, parse_fault
from ...sim.record import RUN_FILE
from ...sim.recorder import Recorder
from ...sim.world import World
from ...skills.context import Perception
from ..runner import Progress, Run
from ..tasks import Task, load_task
from ..worlds import make_world

SIGNS = {"running": ">", "success": "+", "failure": "x", "stopped": "-"}
RATE_HZ = 15.0


def show(progress: Progress) -> None:
    """One line of live progress."""
    indent = "" if progress.kind == "stage" else "    "
    message = f": {progress.message}" if progress.message else ""
    print(f"{progress.time:8.2f} s {indent}{SIGNS[progress.status]} {progress.name}{message}", flush=True)


def free_folder(task: str, seed: int) -> Path:
    """A folder under runs/ that holds no run yet."""
    stem = Path(task).stem
    for number in itertools.count(1):
        folder = Path("runs") / (f"{stem}-seed{seed}" + (f"-{number}" if number > 1 else ""))
        if not (folder / RUN_FILE).exists():
            return folder
    raise AssertionError


def main(options: argparse.Namespace) -> int:
    """Run the task; 0 when it succeeded, else 1.

    Raises:
        CaretreeError: the input is bad or the record cannot be written.
    """
    task = load_task(options.task)
    faults = [parse_fault(text) for text in options.inject]
    parameters = {"gown": options.gown, "person": options.person, "model": options.model, "inject": options.inject,
                  "rate_hz": RATE_HZ, "stage": options.stage}
    parameters = {key: value for key, value in parameters.items() if value not in (None, [])}
    inner, perception = make_world(options.world, task, seed=options.seed, gown=options.gown, person=options.person,
                                   model=options.model, view=options.view)
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)  # being told to end is being interrupted
    try:
        return _run(options, task, inner, perception, faults, parameters)
    finally:
        signal.signal(signal.SIGTERM, before)
        inner.close()


def _run(options: argparse.Namespace, task: Task, inner: World, perception: Perception | None,
         faults: list[FaultSpec], parameters: dict[str, Any]) -> int:
    world = FaultyWorld(inner, faults) if faults else inner
    events = _Events()
    run = Run(task, world, seed=options.seed, rate_hz=RATE_HZ, recorder=events, on_progress=show, perception=perception,
              params={"stage": options.stage} if options.stage else None)
    directory = Path(options.out) if options.out else free_folder(options.task, options.seed)
    recorder = Recorder(directory, task=options.task, seed=options.seed, world=options.world, parameters=parameters)
    events.recorder = recorder
    try:
        for hook, arguments in (("attach_recorder", (recorder,)), ("prepare_stage", (options.stage,))):
            if getattr(inner, hook, None) is not None and arguments[0]:
                getattr(inner, hook)(*arguments)
        result = run.run()
        recorder.finish(result)
    finally:
        recorder.close()
    for trace in run.context.errors:
        (directory / "errors.log").open("a", encoding="utf-8").write(trace + "\n")
    print(f"{result.outcome.replace('_', ' ')}: {result.reason}")
    _report(directory)
    for name in ("report.html", "video.mp4", RUN_FILE):
        if (directory / name).exists():
            print(directory / name)
    return 0 if result.outcome == "success" else 1


class _Events:
    """Hands events to the recorder, which exists only once the task is known to build."""

    recorder: Recorder | None = None

    def event(self, event: Mapping[str, Any]) -> None:
        """Append one event."""
        if self.recorder is not None:
            self.recorder.event(event)


def _report(directory: Path) -> None:
    """The page for the operator; the run counts even when it cannot be drawn."""
    try:
        from ..report import write_report  # matplotlib is needed only here
        write_report(directory)
    except (ImportError, CaretreeError, ValueError) as error:
        print(f"no report: {error}")
