"""Trials on a Ray cluster: its machines need this package, not the campaign's folder; records come back through Ray."""

from __future__ import annotations

import io
import tarfile
import tempfile
import threading
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from ...sim.cluster import Cluster, LostCallError
from ..run.task import load_task
from .key import own_files
from .running import Running
from .trial import InterruptedTrialError, Trial, put_aside, read_trial, run_trial


def trials_on_cluster(
    address: str,
    jobs: int | None,
    task: str,
    arguments: tuple[str, ...],
    folders: Mapping[int, Path],
    *,
    patience: float,
    key: str,
) -> Iterator[tuple[int, Trial | InterruptedTrialError]]:
    """Each seed with its trial as it ends, or with why it counts for nothing.

    Args:
        address: of the cluster.
        jobs: trials at the same time; None for as many as the cluster has cores.
        task: of every run.
        arguments: further arguments of every `caretree run`.
        folders: of the trials, by seed; those that another campaign runs are left out.
        patience: wall time after which a run counts as stuck [s].
        key: of the campaign.
    """
    held: dict[int, Running] = {}
    texts = {path.name: path.read_bytes() for path in own_files(load_task(task).file)}
    files = {text: Path(text).read_bytes() for text in arguments if Path(text).is_file()}

    def calls() -> Iterator[tuple[object, ...]]:
        for seed, folder in folders.items():
            held[seed] = Running(folder, key)
            if held[seed].mine:
                yield (seed, task, texts, files, arguments, patience, key)

    try:
        with Cluster(address, jobs, "--address") as cluster:
            for (seed, *_), found in cluster.each(remote_trial, calls()):
                if isinstance(found, LostCallError):
                    yield seed, InterruptedTrialError(f"seed {seed} was lost and counts for nothing: {found}")
                elif isinstance(found, str):
                    yield seed, InterruptedTrialError(found)
                else:
                    yield seed, _unpacked(found, folders[seed])
                held[seed].release()
    finally:
        for each in held.values():
            each.release()


def remote_trial(
    seed: int,
    task: str,
    texts: Mapping[str, bytes],
    files: Mapping[str, bytes],
    arguments: Sequence[str],
    patience: float,
    key: str,
) -> bytes | str:
    """Run one trial here, in a folder of its own; its record as a tar file, or why it counts for nothing."""
    with tempfile.TemporaryDirectory() as home:
        for name, text in texts.items():
            Path(home, name).write_bytes(text)
        renamed = {name: f"{home}/given-{number}-{Path(name).name}" for number, name in enumerate(files)}
        for name, text in files.items():
            Path(renamed[name]).write_bytes(text)
        directory = Path(home, "campaign", "overall", f"seed-{seed:04d}")
        here = f"{home}/{Path(task).name}" if Path(task).name in texts else task
        given = tuple(renamed.get(text, text) for text in arguments)
        try:
            run_trial(here, seed, directory, given, patience=patience, stop=threading.Event(), key=key)
        except InterruptedTrialError as why:
            return str(why)
        packed = io.BytesIO()
        with tarfile.open(fileobj=packed, mode="w") as file:
            for path in (directory, directory.with_name(f"{directory.name}.log")):
                file.add(path, path.name)
        return packed.getvalue()


def _unpacked(packed: bytes, folder: Path) -> Trial:
    put_aside(folder)
    with tarfile.open(fileobj=io.BytesIO(packed)) as file:
        file.extractall(folder.parent, filter="data")
    trial = read_trial(folder)
    assert trial is not None  # it was there when it was packed
    return trial
