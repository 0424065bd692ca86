"""What a record says that its run was given, read with care: a damaged value is named, never used."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...sim.command_line import RATES, SEEDS
from ...sim.errors import CaretreeError
from ...sim.record.record import RUN_FILE, read_finished_run
from ...sim.world_kind import EASY
from ..run.given_files import HASHES


@dataclass(frozen=True, kw_only=True)
class Recorded:
    """What a run was given.

    Attributes:
        task: name, or path of its file as it was typed.
        task_file, task_hash: where a user's task file was, and what it was; None for a task of the package.
        seed: of the run.
        world: name.
        world_args: what a world that the package does not bring was given, name -> value.
        robot, gown, person, model, stage, look, engine, perception, pregrasp, senses: as on the command line; None
            where nothing was given.
        world_kind: name.
        rate_hz: ticks a second.
        settled_rate_hz: the same once all faults lie behind; None where it stays as it was.
        log_rate: measurements a second that its log asked for, between ticks too; None for those of the tree alone.
        inject: faults, as on the command line.
        tuning: skill -> number -> value.
        start: what `--from` named; None where the run began at its beginning.
        build: parameter of the task -> value.
        versions: of packages, by name.
        file_hashes: of the files of gown and model.
        trace_hash: of the run's events.
    """

    task: str
    seed: int
    world: str
    task_file: str | None = None
    task_hash: str | None = None
    robot: str | None = None
    gown: str | None = None
    person: str | None = None
    model: str | None = None
    stage: str | None = None
    look: str | None = None
    engine: str | None = None
    perception: str | None = None
    pregrasp: str | None = None
    senses: str | None = None
    start: str | None = None
    world_kind: str = EASY  # records from before there were kinds
    rate_hz: float = 15.0
    settled_rate_hz: float | None = None
    log_rate: float | None = None
    inject: tuple[str, ...] = ()
    tuning: Mapping[str, Mapping[str, Any]]
    build: Mapping[str, Any]
    world_args: Mapping[str, Any]
    versions: Mapping[str, str]
    file_hashes: Mapping[str, str]
    trace_hash: str | None = None


def recorded(directory: Path) -> Recorded:
    """What the finished run in `directory` was given.

    Raises:
        CaretreeError: its run.json is not there, unfinished or damaged; says which value.
    """
    run = read_finished_run(directory)
    file = directory / RUN_FILE
    given = _value(file, run, "parameters", dict, _is_mapping, {})
    names = (
        "task_file",
        "task_hash",
        "robot",
        "gown",
        "person",
        "model",
        "stage",
        "look",
        "engine",
        "perception",
        "pregrasp",
        "senses",
    )
    optional = {name: _value(file, given, name, str, _is_text, None) for name in names}
    return Recorded(
        task=_value(file, run, "task", str, _is_text),
        seed=_value(file, run, "seed", int, _is_seed),
        world=_value(file, run, "world", str, _is_text),
        world_kind=_value(file, given, "world_kind", str, _is_text, EASY),
        rate_hz=_value(file, given, "rate_hz", float, _is_rate, 15.0),
        settled_rate_hz=_value(file, given, "settled_rate_hz", float, _is_rate, None),
        log_rate=_value(file, given, "log_rate", float, _is_rate, None),
        inject=_value(file, given, "inject", tuple, _is_texts, ()),
        tuning=_value(file, given, "tuning", dict, _is_tuning, {}),
        build=_value(file, given, "build", dict, _is_mapping, {}),
        world_args=_value(file, given, "world_args", dict, _is_mapping, {}),
        versions=_value(file, run, "versions", dict, _is_mapping, {}),
        file_hashes=_value(file, given, HASHES, dict, _is_mapping, {}),
        start=_value(file, given, "from", str, _is_text, None),
        trace_hash=_value(file, run, "trace_hash", str, _is_text, None),
        **optional,
    )


_MISSING: Any = object()


def _value(
    file: Path,
    values: Mapping[str, Any],
    name: str,
    kind: type,
    fits: Callable[[Any], bool],
    default: Any = _MISSING,
) -> Any:
    value = values.get(name)
    if value is None and default is not _MISSING:
        return default
    if not fits(value):
        raise CaretreeError(f"{file} is damaged: {name} is {str(value)[:60]!r}")
    return kind(value)


def _is_text(value: Any) -> bool:
    return isinstance(value, str) and bool(value)


def _is_texts(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(each, str) for each in value)


def _is_seed(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < SEEDS


def _is_rate(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and RATES[0] <= value <= RATES[1]


def _is_mapping(value: Any) -> bool:
    return isinstance(value, dict)


def _is_tuning(value: Any) -> bool:
    return isinstance(value, dict) and all(isinstance(each, dict) for each in value.values())
