"""Worlds by the name given on the command line; what they need is imported only when they are asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...sim.abilities import SupportsInitialStates
from ...sim.errors import CaretreeError
from ...sim.world_kind import EASY, WorldKind

if TYPE_CHECKING:
    from ...perception.senses import Senses
    from ...sim.world import World
    from .task import Task

WORLDS = ("bullet", "scripted")


def make_world(
    name: str,
    task: Task,
    *,
    seed: int,
    gown: str | None = None,
    person: str | None = None,
    model: str | None = None,
    kind: str = EASY,
) -> tuple[World, Senses | None]:
    """The world called `name`, as hard as `kind` says and furnished by the task; its senses where these are scripted.

    Raises:
        CaretreeError: an unknown world or kind, an option that this world does not take, or a world that is not there.
    """
    if name == "scripted":
        asked: dict[str, object] = {"--gown": gown, "--person": person, "--model": model}
        asked["--world-kind"] = WorldKind.named(kind).difficulties
        given = [flag for flag, value in asked.items() if value]
        if given:
            raise CaretreeError(f"{given[0]} needs the bullet world: the scripted world has no cloth and no person")
        return task.scripted(seed)
    if name != "bullet":
        raise CaretreeError(f"unknown world {name!r}; there are {', '.join(WORLDS)}")
    try:
        from ...sim.bullet.world import BulletWorld  # pyright: ignore[reportMissingImports] pulls pybullet and pinocchio
    except ImportError as error:
        raise CaretreeError(f"the bullet world cannot be loaded: {error}") from error
    options: dict[str, Any] = {"gown": gown, "person": person, "model": model, "kind": kind}
    options = {key: value for key, value in options.items() if value is not None}
    world = BulletWorld(seed=seed, **options)
    try:
        task.furnish(world, seed)
    except CaretreeError:
        world.close()
        raise
    return world, None


def prepare_stage(world: World, task: Task, stage: str | None) -> None:
    """Bring a world to where a stage of a task begins, or the first one of a span; None stands for the whole task.

    Raises:
        CaretreeError: the task has no such stage, or this world cannot begin there.
    """
    state = task.initial_state(stage)
    if not state:
        return
    if not isinstance(world, SupportsInitialStates):
        raise CaretreeError(f"stage {stage!r} begins with {state!r}, but {type(world).__name__} has one beginning only")
    world.set_initial_state(state)
