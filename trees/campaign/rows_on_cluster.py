"""Rows of the fault campaign on a Ray cluster: neighbouring places go together, so that a worker's runs share a way."""

from __future__ import annotations

import itertools
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...sim.cluster import Cluster, LostCallError
from ..run.task import load_task
from .fault_row import FaultKey, Row
from .key import own_files
from .rows_process import RowsProcess
from .run_maker import RunRecipe
from .ways import Place, Way

PLACES = 12  # of one call: enough to share a way, and few enough for every core to have some


def rows_on_cluster(
    address: str, jobs: int | None, recipe: RunRecipe, ways: Mapping[FaultKey, Way], *, forks: bool
) -> Iterator[Row]:
    """Rows as their calls end; those of a lost call are missing.

    Args:
        address: of the cluster.
        jobs: calls at the same time; None for as many as the cluster has cores.
        recipe: of the runs.
        ways: the rows, and how their places are reached.
        forks: whether the rows of a call may share what they have in common.

    Raises:
        CaretreeError: no cluster, or its machines cannot make such runs.
    """
    texts = {path.name: path.read_bytes() for path in own_files(load_task(recipe.task).file)}
    calls = [(number, recipe, texts, part, forks) for number, part in enumerate(parts(ways))]
    with Cluster(address, jobs, "--address") as cluster:
        for _, found in cluster.each(remote_rows, calls):
            if not isinstance(found, LostCallError):
                yield from found


def parts(ways: Mapping[FaultKey, Way]) -> list[dict[FaultKey, Way]]:
    """The rows in groups of so many places, in their order."""
    by_place: dict[Place, dict[FaultKey, Way]] = {}
    for (node, phase, fault), way in ways.items():
        by_place.setdefault((node, phase), {})[node, phase, fault] = way
    each = iter(by_place.values())
    groups = iter(lambda: list(itertools.islice(each, PLACES)), [])
    return [{key: way for rows in group for key, way in rows.items()} for group in groups]


def remote_rows(
    number: int, recipe: RunRecipe, texts: Mapping[str, bytes], ways: Mapping[FaultKey, Way], forks: bool
) -> list[Row]:
    """Try some rows in a process of this machine; the call has a number."""
    with tempfile.TemporaryDirectory() as home:
        for name, text in texts.items():
            Path(home, name).write_bytes(text)
        name = Path(recipe.task).name
        here: dict[str, Any] = {"task": f"{home}/{name}"} if name in texts else {}
        process = RowsProcess(replace(recipe, **here), ways, forks=forks)
        try:
            return list(process.rows())
        finally:
            process.end()
