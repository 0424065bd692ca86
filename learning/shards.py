"""Shards of a dataset, made here one after the other, or many at once with Ray."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, TypeVar

from ..sim.cluster import Cluster, LostCallError
from ..sim.command_line import at_least_one
from ..sim.errors import CaretreeError

Shard = TypeVar("Shard")


def add_cluster_options(parser: argparse.ArgumentParser) -> None:
    """`--jobs` and `--address`, as `each_shard` takes them."""
    parser.add_argument(
        "--jobs",
        type=at_least_one,
        metavar="N",
        help="shards at once (1; on a cluster as many as it has cores); more than 1 needs Ray",
    )
    parser.add_argument("--address", metavar="ray://...", help="make it on a Ray cluster")


def shard_name(number: int) -> str:
    """File name of a shard."""
    return f"shard_{number:04d}.npz"


def replace_file(path: Path, data: bytes) -> None:
    """Write a file whole, or not at all: who is interrupted leaves the former one."""
    part = path.with_name(path.name + ".part")
    with part.open("wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    os.replace(part, path)


def each_shard(
    make: Callable[..., Shard], numbers: Iterable[int], *given: Any, jobs: int | None, address: str | None
) -> Iterator[tuple[int, Shard]]:
    """Each number with its shard, as they get ready.

    Args:
        make: `make(number, *given)` makes one; a function of a module, as it is called on other machines.
        numbers: of the shards to make.
        given: what all of them need; sent to a cluster once.
        jobs: shards at once; None for one here, and on a cluster for as many as it has cores.
        address: of a Ray cluster; None for this machine.

    Raises:
        CaretreeError: Ray is asked for and not installed or not reached, or shards were lost with their workers: the
            others have been handed out by then.
    """
    if address is None and (jobs or 1) < 2:
        for number in numbers:
            yield number, make(number, *given)
        return
    lost = 0
    with Cluster(address, jobs, "more than one job" if address is None else "--address") as cluster:
        shared = [cluster.share(value) for value in given]
        for (number, *_), shard in cluster.each(make, [(number, *shared) for number in numbers], retries=3):
            if isinstance(shard, LostCallError):
                lost += 1
            else:
                yield number, shard
    if lost:
        raise CaretreeError(f"{lost} shards were lost with their workers; the same command makes them")
