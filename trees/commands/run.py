"""`caretree run`: one run, its progress, its record, its outcome in one sentence."""

from __future__ import annotations

import argparse
import errno
import sys
from collections.abc import Mapping
from contextlib import closing, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...perception.estimates import ArmPosture
from ...perception.senses import Senses
from ...sim.abilities import HasTiming, SupportsRecording
from ...sim.command_line import drop_output
from ...sim.errors import CaretreeError, DisplayError, RecordError
from ...sim.evaluate.run_record import Judgement
from ...sim.extras import missing_extra, need
from ...sim.faults import FaultSpec, FaultyWorld, parse_fault
from ...sim.fence import said
from ...sim.log.logged_world import logged_into
from ...sim.record.folder_claim import FolderClaim, claim_free
from ...sim.record.record import ERRORS_FILE, LOG_FILE, RUN_FILE, VIDEO_FILE, RunResult
from ...sim.record.recorder import Recorder
from ...sim.world import Observation, World
from ...sim.world_kind import WorldKind
from ..campaign.recorded_task import noted
from ..cli import IN_THE_RECORD
from ..proof.check import refuse_faulty
from ..report.looks import LookLog, Witness
from ..report.outline import outline_of, write_outline
from ..run.given_files import HASHES, hashes_of, place_files
from ..run.judging import judge_and_keep
from ..run.perceptions import CLASSICAL, grasp_with, see_with
from ..run.progress import Progress
from ..run.recorded_start import read_start, take_room
from ..run.runner import Run
from ..run.stop_signals import StopSignals
from ..run.task import Task, load_task
from ..run.tuning import Given, read_given
from ..run.worlds import (
    TICK_RATE,
    closed_after,
    make_world,
    prepare_stage,
    read_world_arguments,
    senses_for,
    tick_rate_of,
)
from ..watch.watchers import Watchers

SIGNS = {"running": ">", "success": "+", "failure": "x", "stopped": "-"}
BULLET = "bullet"  # the world, and the engine of its cloth unless another one is asked for
GONE = {errno.EIO: "the terminal was closed", errno.EPIPE: "nobody reads the output any more"}


def show(progress: Progress) -> None:
    """One line of live progress.

    Raises:
        DisplayError: the terminal, or whoever else reads it, has gone; nothing is printed from then on.
    """
    indent = "" if progress.kind == "stage" else "    "
    message = f": {progress.message}" if progress.message else ""
    try:
        print(f"{progress.time:8.2f} s {indent}{SIGNS[progress.status]} {progress.name}{message}", flush=True)
    except OSError as error:
        drop_output()
        why = GONE.get(error.errno or 0, f"printing failed: {said(error)}")
        if error.errno not in GONE:
            with suppress(OSError):
                print(f"caretree: {why}; the run ends in the safe stop", file=sys.stderr, flush=True)
        raise DisplayError(why) from error


def main(options: argparse.Namespace) -> int:
    """Run the task; 0 when it succeeded, for its own judge too if it has one, else 1.

    Raises:
        CaretreeError: the input is bad, or some of the record could not be written.
    """
    task = load_task(options.task, robot=options.robot)
    place_files(options)
    start = read_start(options.start) if options.start else None
    if start is not None:
        take_room(options, start.directory)
    if not options.unchecked:
        refuse_faulty(task, options.stage, "`run --unchecked` runs it nevertheless")
    faults = [parse_fault(text) for text in options.inject]
    given = read_given(options.set, options.tuning)
    given = replace(given, parameters=task.values(given.parameters))
    arguments = read_world_arguments(options.world, options.world_arg)
    parameters = {
        "world_kind": WorldKind.named(options.world_kind).name,
        "world_args": arguments,
        "robot": options.robot,
        "senses": None if options.senses == "own" else options.senses,
        "perception": None if options.perception == CLASSICAL else options.perception,
        "pregrasp": None if options.pregrasp == CLASSICAL else options.pregrasp,
        "gown": options.gown,
        "person": options.person,
        "model": options.model,
        HASHES: hashes_of(vars(options)),
        "look": options.look,
        "engine": options.engine or (BULLET if options.world == BULLET else None),
        "inject": options.inject,
        "log_rate": options.log_rate,
        "stage": options.stage,
        "from": start and str(start),
        "tuning": given.settings.values,
        "build": given.parameters,
    }
    parameters = {key: value for key, value in parameters.items() if value not in (None, [], {})}
    if options.log is not None:
        need("mcap", "the log")
    elif options.log_rate is not None:
        raise CaretreeError("--log-rate is the rate of the log: give --log too")
    with closing(Watchers(options)) as watchers:
        # claimed before the world is built, which takes a while: two runs begun together get a folder each
        claim = (
            FolderClaim(Path(options.out))
            if options.out
            else claim_free(Path("runs"), f"{Path(options.task).stem}-seed{options.seed}")
        )
        if options.log == IN_THE_RECORD:
            options.log = str(claim.directory / LOG_FILE)
        try:
            with StopSignals() as signals:
                inner, senses = make_world(
                    options.world,
                    task,
                    seed=options.seed,
                    gown=options.gown,
                    person=options.person,
                    model=options.model,
                    kind=options.world_kind,
                    look=options.look,
                    engine=options.engine,
                    arguments=arguments,
                )
                with closed_after(inner):
                    senses = senses or senses_for(options.senses, task, inner, options.seed)
                    if start is None:
                        prepare_stage(inner, task, options.stage)
                    else:
                        start.prepare(inner)
                    with logged_into(inner, options.log, options.log_rate) as measured:
                        return _run(
                            options, task, inner, measured, senses, faults, given, parameters, claim, signals, watchers
                        )
        finally:
            claim.release()


def _run(
    options: argparse.Namespace,
    task: Task,
    inner: World,
    measured: World,
    senses: Senses | None,
    faults: list[FaultSpec],
    given: Given,
    parameters: dict[str, Any],
    claim: FolderClaim,
    signals: StopSignals,
    watchers: Watchers,
) -> int:
    world = FaultyWorld(measured, faults) if faults else measured
    settled_rate_hz = tick_rate_of(inner)
    rate_hz = TICK_RATE if faults else settled_rate_hz  # how soon a fault is answered is looked at
    parameters = {**parameters, **noted(task), "rate_hz": rate_hz, "settled_rate_hz": settled_rate_hz}
    events = _Events()
    run = Run(
        task,
        world,
        seed=options.seed,
        rate_hz=rate_hz,
        settled_rate_hz=settled_rate_hz,
        recorder=events,
        on_progress=events.progress,
        senses=senses,
        params=given.parameters | task.parameters(options.stage),
        settings=given.settings,
        before_tick=watchers.before_tick,
        on_sample=events.sample,
    )
    witness = Witness(events.arm)
    see_with(run.context, options.perception, scripted=senses is not None)
    grasp_with(run.context, options.pregrasp, scripted=senses is not None)
    run.context.wrap_senses(witness.watch)
    directory = claim.directory
    recorder = Recorder(
        claim,
        task=options.task,
        seed=options.seed,
        world=options.world,
        parameters=parameters,
        films=options.video == "on",
    )
    events.recorder, events.looks, events.watchers = recorder, LookLog(directory, witness), watchers
    try:
        write_outline(directory, outline_of(run.root))
        watchers.follow(run, inner, witness)
        if isinstance(inner, SupportsRecording):
            inner.attach_recorder(recorder, run.lost)
        signals.run = run
        result = run.run()
        if isinstance(inner, HasTiming):
            of_world = inner.stopwatch
            result = replace(
                result,
                timing=_timing(result.timing, of_world.wall),
                processor_timing=_timing(result.processor_timing, of_world.processor),
            )
        if isinstance(world, FaultyWorld):
            recorder.note(faults=[{"fault": str(spec), "t": time} for spec, time in world.begun])
        problem = _finish(recorder, result)
    finally:
        recorder.close()
    judgement, misjudged = _judged(task, directory)
    written = [_errors(directory, run.context.errors), _report(directory), directory / VIDEO_FILE, directory / RUN_FILE]
    written += [Path(options.log)] if options.log else []
    if isinstance(world, FaultyWorld):
        _tell_faults(world)
    watchers.finish(result.reason, directory)
    print(f"{result.outcome.replace('_', ' ')}: {result.reason}")
    if judgement is not None:
        print(f"judged from the truth: {judgement}")
    for path in written:
        if path is not None and path.exists():
            print(path)
    for error in (problem, misjudged):
        if error is not None:
            raise error
    return 0 if result.outcome == "success" and (judgement is None or judgement.success) else 1


def _judged(task: Task, directory: Path) -> tuple[Judgement | None, CaretreeError | None]:
    """What the task's own judge says, if it has one; its own error is told after the outcome."""
    try:
        return judge_and_keep(task, directory), None
    except CaretreeError as error:
        return None, error


def _finish(recorder: Recorder, result: RunResult) -> RecordError | None:
    """Write the outcome; what of the record could not be written, if anything, is told after the outcome."""
    try:
        recorder.finish(result)
    except RecordError as error:
        return error
    return None


class _Events:
    """Hands on what happens, to the recorder and whoever watches, which exist only once the task is known to build."""

    recorder: Recorder | None = None
    looks: LookLog | None = None
    watchers: Watchers | None = None

    def event(self, event: Mapping[str, Any]) -> None:
        """Append one event."""
        if self.recorder is not None:
            self.recorder.event(event)
        if self.looks is not None:
            self.looks.event(event)
        if self.watchers is not None:
            self.watchers.event(event)

    def sample(self, seen: Observation) -> None:
        """Keep what the robot measured."""
        if self.recorder is not None:
            self.recorder.measured.sample(seen)

    def arm(self, arm: ArmPosture) -> None:
        """Keep an arm as it was seen."""
        if self.recorder is not None:
            self.recorder.measured.arm(arm.stamp, arm.side, arm.points_in_map)

    def progress(self, progress: Progress) -> None:
        """Write stage and skill on the video and the page, and tell the operator."""
        if self.recorder is not None and progress.status == "running":
            stage = self.recorder.caption[0]
            words = f"{progress.name}{f': {progress.message}' if progress.message else ''}"
            self.recorder.caption = (progress.name, "") if progress.kind == "stage" else (stage, words)
        if self.watchers is not None:
            self.watchers.progress(progress)
        show(progress)


def _tell_faults(world: FaultyWorld) -> None:
    """Which of the faults that were asked for came to act, and when."""
    begun = {id(spec): time for spec, time in world.begun}
    for spec in world.faults:
        if id(spec) in begun:
            print(f"{begun[id(spec)]:8.2f} s ! {spec}")
        else:
            print(f"   never ! {spec}: the run did not come to that phase of that node")


def _timing(of_run: Mapping[str, float], of_world: Mapping[str, float]) -> Mapping[str, float]:
    """Where the time went [s]: the world's own account, where it keeps one, in place of the runner's rough one.

    Cameras are drawn while the tree is ticked, and frames are recorded while the world advances.
    """
    if not {"cameras", "physics"} <= set(of_world):
        return of_run
    return {"tree": of_run["tree"] - of_world["cameras"], **of_world}


def _report(directory: Path) -> Path | None:
    """The page for the operator; the run counts even when it cannot be drawn."""
    try:
        from ..report.page import write_report  # matplotlib is needed only here

        return write_report(directory)
    except ModuleNotFoundError as error:
        print(f"no report: {missing_extra(error) or said(error)}")
        return None
    except Exception as error:  # a font without a sign of a skill's name must not end what has run
        print(f"no report: {said(error)}")
        return None


def _errors(directory: Path, errors: list[str]) -> Path | None:
    """Keep the tracebacks of errors that the run has survived."""
    if not errors:
        return None
    path = directory / ERRORS_FILE
    try:
        path.write_text("\n".join(errors), encoding="utf-8", errors="backslashreplace")
    except OSError as error:
        print(f"no {ERRORS_FILE}: {error.strerror or error}")
        return None
    return path
