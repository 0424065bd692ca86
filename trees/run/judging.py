"""A task's own judge: asked when a run on a world with truth is over, its answer kept in run.json."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...sim.errors import CaretreeError, RecordError
from ...sim.evaluate.run_record import Judgement
from ...sim.record.record import TRUTH_FILE, read_run, write_run
from .task import Task

KEY = "judgement"  # in run.json


def judge_and_keep(task: Task, directory: Path) -> Judgement | None:
    """Judge the finished run in `directory` and write the answer into its run.json; None where there is no judge.

    A world without truth (the scripted one) leaves nothing to judge.

    Raises:
        CaretreeError: the judge's own code fails, which is kept as a run that did not reach its goal.
    """
    if task.judge is None or not (directory / TRUTH_FILE).exists():
        return None
    try:
        found = task.judged(directory)
    except CaretreeError as error:
        _keep(directory, Judgement(success=False, problems=(f"it could not be judged: {error}",)))
        raise
    _keep(directory, found)
    return found


def _keep(directory: Path, found: Judgement) -> None:
    write_run(directory, read_run(directory) | {KEY: found.as_dict()})


def kept(run: Mapping[str, Any]) -> Judgement | None:
    """The judgement in a run.json; None where there is none.

    Raises:
        RecordError: it is damaged.
    """
    found = run.get(KEY)
    if found is None:
        return None
    try:
        problems = tuple(str(problem) for problem in found["problems"])
        numbers = {str(name): float(value) for name, value in found["numbers"].items()}
        return replace(Judgement(success=bool(found["success"]), problems=problems), numbers=numbers)
    except (TypeError, KeyError, ValueError, AttributeError) as error:
        raise RecordError(f"the {KEY} of run.json is damaged: {error}") from error
