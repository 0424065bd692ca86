"""`--from RECORD@SECONDS`: a run that begins where another one was, in the same room with the same person and gown."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

from ...sim.abilities import SupportsRecordedStates
from ...sim.errors import CaretreeError
from ...sim.record.record import RUN_FILE, read_run
from ...sim.record.recorded_state import RecordedState, recorded_state
from ...sim.world import World
from .given_files import changed_files

HOW = "--from asks for RECORD@SECONDS, such as runs/dressing-seed0@286.7"
# What makes the room what it is: option -> its value where nothing is given.
OF_THE_ROOM = {
    "seed": 0,
    "world_kind": "easy",
    "gown": None,
    "person": None,
    "look": None,
    "model": None,
    "engine": None,
}


@dataclass(frozen=True, kw_only=True)
class RecordedStart:
    """Where a run begins.

    Attributes:
        directory: of the record.
        state: of the instant asked for.
    """

    directory: Path
    state: RecordedState

    def __str__(self) -> str:
        """As on the command line, with the time of the frame that is there."""
        return f"{self.directory}@{self.state.t:.2f}"

    def prepare(self, world: World) -> None:
        """Bring a world there.

        Raises:
            CaretreeError: it cannot begin there.
        """
        if not isinstance(world, SupportsRecordedStates):
            raise CaretreeError(f"--from needs a world that can begin anywhere, but {type(world).__name__} cannot")
        world.set_recorded_state(self.state)


def read_start(text: str) -> RecordedStart:
    """What `--from` names.

    Raises:
        CaretreeError: the text names no record and time, or the run cannot begin there.
    """
    folder, at, seconds = text.rpartition("@")
    try:
        time = float(seconds)
    except ValueError:
        time = float("nan")
    if not at or not folder or not 0 <= time < float("inf"):
        raise CaretreeError(f"{HOW}, not {text!r}")
    read_run(Path(folder))  # else the lack of a file in it is told of a folder that there is not
    return RecordedStart(directory=Path(folder), state=recorded_state(Path(folder), time))


def take_room(options: argparse.Namespace, directory: Path) -> None:
    """Let a run be in the room of the record: the seed, the gown, the person and what else was given then.

    Args:
        options: of the command line; changed.
        directory: of the record.

    Raises:
        CaretreeError: the record's run.json is damaged, something else was asked for than it was given, or a file that
            it was given is another one by now.
    """
    run = read_run(directory)
    given = run.get("parameters")
    if not isinstance(given, dict):
        raise CaretreeError(f"{directory / RUN_FILE} is damaged: it has no parameters")
    if run.get("world") != options.world:
        raise CaretreeError(f"--from: {directory} was run on {run.get('world')!r}, not on {options.world!r}")
    if changed := changed_files(given):
        raise CaretreeError(f"--from: {changed} {directory} was recorded, and the room would be another one")
    for name, default in OF_THE_ROOM.items():
        then = run.get("seed") if name == "seed" else given.get(name, default)
        asked = getattr(options, name)
        if asked not in (default, then):
            flag = "--" + name.replace("_", "-")
            raise CaretreeError(f"--from: {directory} was run with {flag} {then}, not {asked}; leave {flag} out")
        setattr(options, name, then)
