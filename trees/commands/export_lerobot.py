"""`caretree export lerobot RECORD...`: the logs of runs as one LeRobot dataset, an episode each."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from ...sim.command_line import RATES, at_least_one
from ...sim.errors import CaretreeError, RecordError
from ...sim.extras import need
from ...sim.log.episode import Episode, episode_of
from ...sim.log.lerobot import LeRobotDataset
from ...sim.log.robot_log import read_log
from ...sim.record.record import RUN_FILE, read_run

RATE = 10  # [Hz], within what most LeRobot datasets have (10 to 50), below the 15 ticks a second of a run


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the form to the command line; `main` runs it."""
    parser = subparsers.add_parser(
        "lerobot",
        help="what robots did: a LeRobot dataset",
        description="Runs made with --log, as one LeRobot dataset, version 3.0; an episode each, whatever its outcome.",
    )
    parser.add_argument("records", nargs="+", metavar="DIR", help="record of a run with --log, or such a log itself")
    parser.add_argument(
        "--out", required=True, metavar="DIR", help="folder of the dataset, which must not be there yet"
    )
    parser.add_argument("--fps", type=_rows, default=RATE, metavar="N", help=f"rows a second (default: {RATE})")
    parser.add_argument("--task", metavar="TEXT", help="what they do, in words (default: the name of the task)")
    parser.add_argument("--camera", action="append", metavar="NAME", help="this camera alone; can be given again")
    parser.set_defaults(main=main)


def _rows(text: str) -> int:
    """Rows a second, whole, and no more than a log has."""
    rows = at_least_one(text)
    if rows > RATES[1]:
        raise argparse.ArgumentTypeError(f"{text!r}, but at most {RATES[1]:g} rows a second are asked for")
    return rows


def main(options: argparse.Namespace) -> int:
    """Write the dataset.

    Raises:
        CaretreeError: a record has no log, the logs do not fit together, or the disk is full.
    """
    for package in ("mcap", "pyarrow", "av", "cv2"):
        need(package, "export lerobot")
    logs = [log_of(Path(record)) for record in options.records]
    dataset = LeRobotDataset(Path(options.out), options.fps)
    try:
        for path in logs:
            episode = _seen_by(episode_of(read_log(path), options.fps), options.camera, path)
            name, outcome = _of_run(path)
            try:
                dataset.add(episode, options.task or name)
            except RecordError as error:
                raise RecordError(f"{path}: {error}") from error
            cameras = ", ".join(episode.pictures) or "no camera"
            print(f"{path}: {len(episode)} rows, {cameras}, {outcome}", flush=True)
        dataset.finish()
    finally:
        dataset.discard()
    print(options.out)
    return 0


def log_of(record: Path) -> Path:
    """The log of a record, or the file itself.

    Raises:
        RecordError: there is none, or there are several.
    """
    if not record.is_dir():
        return record
    found = sorted(record.glob("*.mcap"))
    if len(found) != 1:
        there = ", ".join(path.name for path in found) or "no log"
        raise RecordError(
            f"{record} has {there}: one is asked for, which `caretree run TASK --log` writes, or its path"
        )
    return found[0]


def _of_run(path: Path) -> tuple[str, str]:
    """Task in words and outcome of the run whose log this is, as far as a record beside it tells."""
    if not (path.parent / RUN_FILE).exists():
        return path.stem.replace("_", " "), "outcome unknown"
    run = read_run(path.parent)
    return Path(run["task"]).stem.replace("_", " "), str(run["outcome"]).replace("_", " ")


def _seen_by(episode: Episode, cameras: list[str] | None, path: Path) -> Episode:
    if cameras is None:
        return episode
    for camera in cameras:
        if camera not in episode.pictures:
            raise CaretreeError(f"{path} has no pictures of {camera!r}, but of {', '.join(episode.pictures) or 'none'}")
    return replace(episode, pictures={camera: episode.pictures[camera] for camera in cameras})
