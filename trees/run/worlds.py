"""Worlds by the name given on the command line; what they need is imported only when they are asked for.

Besides those of the package there are those of anybody else (`open_world.py`).
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ...sim.abilities import HasTickRate, SupportsInitialStates, SupportsObjects
from ...sim.blame import OF_FOREIGN_CODE, told
from ...sim.errors import CaretreeError
from ...sim.extras import missing_extra
from ...sim.world_kind import EASY, WorldKind
from .open_world import HOW, OpenWorld, installed_worlds

if TYPE_CHECKING:
    from ...perception.senses import Senses
    from ...sim.world import World
    from .task import Task

WORLDS = ("bullet", "scripted")
TICK_RATE = 15.0  # [Hz] of trees


def make_world(
    name: str,
    task: Task,
    *,
    seed: int,
    gown: str | None = None,
    person: str | None = None,
    model: str | None = None,
    kind: str = EASY,
    look: str | None = None,
    engine: str | None = None,
    arguments: Mapping[str, Any] | None = None,
) -> tuple[World, Senses | None]:
    """The world called `name`, as hard as `kind` says and furnished by the task; its senses where these are scripted.

    Args:
        name: one of `WORLDS`, or as `open_world.py` tells.
        task: furnishes the world, if this takes objects: a real room is as it is.
        seed: of all that varies.
        gown: of the bullet world.
        person: of the bullet world.
        model: of the bullet world.
        kind: of the bullet world.
        look: of the bullet world; None leaves it as it is.
        engine: of the bullet world's cloth; None leaves it as it is.
        arguments: of a world that the package does not bring, name -> value.

    Raises:
        CaretreeError: an unknown world or kind, an option that this world does not take, or a world that is not there.
    """
    if task.robot is not None and name not in WORLDS:
        raise CaretreeError(f"--robot {task.robot.name} needs one of {', '.join(WORLDS)}: {name} brings its own")
    if name != "bullet":
        asked: dict[str, object] = {"--gown": gown, "--person": person, "--model": model, "--look": look}
        asked["--engine"] = engine
        asked["--world-kind"] = WorldKind.named(kind).difficulties
        given = [flag for flag, value in asked.items() if value]
        if given:
            why = "the scripted world has no cloth and no person" if name == "scripted" else f"{name} brings its own"
            raise CaretreeError(f"{given[0]} needs the bullet world: {why}")
    if name not in WORLDS:
        world = _open_world(name).make(seed, arguments or {})
        _furnish(world, task, seed, only_if_taken=True)
        return world, None
    if arguments:
        raise CaretreeError(f"the {name} world takes no --world-arg")
    if name == "scripted":
        return task.scripted(seed)
    try:
        from ...sim.bullet.world import BulletWorld  # pyright: ignore[reportMissingImports] pulls pybullet and pinocchio
    except ImportError as error:
        if isinstance(error, ModuleNotFoundError) and (missing := missing_extra(error, "sim")) is not None:
            raise missing from error
        raise CaretreeError(f"the bullet world cannot be loaded: {error}") from error
    options: dict[str, Any] = {"gown": gown, "person": person, "model": model, "kind": kind, "look": look}
    options |= {"engine": engine, "robot": task.robot}
    options = {key: value for key, value in options.items() if value is not None}
    world = BulletWorld(seed=seed, **options)
    _furnish(world, task, seed)
    return world, None


@contextmanager
def closed_after(world: World) -> Iterator[None]:
    """Release a world in the end; that it does not let go is told, and changes nothing of how its run went."""
    try:
        yield
    finally:
        try:
            world.close()
        except OF_FOREIGN_CODE as error:
            print(f"caretree: the world could not be closed: {told(error)}", file=sys.stderr, flush=True)


def senses_for(choice: str, task: Task, world: World, seed: int) -> Senses | None:
    """What sees on a world that brings no senses of its own: `own`, the task's, or `scripted`, made up.

    Raises:
        CaretreeError: the task has no scripted senses that another world could use.
    """
    if choice != "scripted":
        return None
    model, senses = task.scripted(seed)
    model.close()
    if (on := getattr(senses, "on", None)) is None:
        raise CaretreeError(f"task {task.name!r} has no scripted senses for another world")
    return on(world)


def read_world_arguments(name: str, texts: Sequence[str]) -> dict[str, Any]:
    """What `--world-arg` gives the world called `name`, checked before anything is made.

    Raises:
        CaretreeError: an unknown world, an option that it does not take, or a value that will not do.
    """
    if name not in WORLDS:
        return _open_world(name).read(texts)
    if texts:
        raise CaretreeError(f"the {name} world takes no --world-arg")
    return {}


def tick_rate_of(world: World) -> float:
    """Ticks a second of a run in which nobody injects faults."""
    return world.tick_rate if isinstance(world, HasTickRate) else TICK_RATE


def _open_world(name: str) -> OpenWorld:
    if ":" not in name and name not in (installed := installed_worlds()):
        raise CaretreeError(f"unknown world {name!r}; there are {', '.join((*WORLDS, *installed))}, {HOW}")
    return OpenWorld(name)


def _furnish(world: World, task: Task, seed: int, *, only_if_taken: bool = False) -> None:
    if only_if_taken and not isinstance(world, SupportsObjects):
        return
    try:
        task.furnish(world, seed)
    except CaretreeError:
        world.close()
        raise


def prepare_stage(world: World, task: Task, stage: str | None) -> None:
    """Bring a world to where a stage of a task begins, or the first one of a span; None stands for the whole task.

    Raises:
        CaretreeError: the task has no such stage, or this world cannot begin there.
    """
    state = task.initial_state(stage)
    if not state:
        return
    if not isinstance(world, SupportsInitialStates):
        if stage is None:
            return  # a real room is as people have left it
        raise CaretreeError(f"stage {stage!r} begins with {state!r}, but {type(world).__name__} has one beginning only")
    world.set_initial_state(state)
