"""Tasks by name, one file each: a module with `build(context, **params)` that returns the tree's root.

A module may also have

- `scripted(seed) -> (ScriptedWorld, Senses or None)`: the world on which `caretree check`, `caretree inject` and
  `--world scripted` try the task;
- `STAGES`, a dictionary of `TaskStage` by name and in order: `--stage` then runs some of them alone, and `build` is
  given their names as `stages`.

A user's own file works the same: `caretree run path/to/task.py`.
"""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import pkgutil
import sys
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any, cast

from py_trees.behaviour import Behaviour

from ...perception.senses import Senses
from ...sim.errors import CaretreeError
from ...sim.scripted.world import ScriptedWorld
from ...sim.world import World
from ...skills.core.context import Context
from ...skills.core.settings import SettingError
from .. import tasks
from .stages import TaskStage, span_of

JUDGED = ("dressing",)  # tasks after which somebody should be dressed


class TaskError(CaretreeError):
    """A task that does not exist or cannot be built; says `file:line` where it can."""


@dataclass(frozen=True)
class Task:
    """What a run does.

    Attributes:
        name: as given on the command line.
        function: `build(context, **params)` of its module.
        file: where it is written.
        script: `scripted(seed)` of its module, if it has one: the scripted world and senses to try it on.
        stages: by name and in order, if its module names any.
    """

    name: str
    function: Callable[..., Behaviour]
    file: Path
    script: Callable[[int], tuple[World, Senses | None]] | None = None
    stages: Mapping[str, TaskStage] = field(default_factory=dict)

    def parameters(self, stage: str | None) -> dict[str, Any]:
        """What `build` is given to run a stage or a span of them alone; nothing for the whole task (None).

        Raises:
            TaskError: the task has no such stage.
        """
        return {} if stage is None else {"stages": self._span(stage)}

    def initial_state(self, stage: str | None) -> str:
        """Name of the world's state in which a stage or a span of them begins; empty where any will do.

        Raises:
            TaskError: the task has no such stage.
        """
        return "" if stage is None else self.stages[self._span(stage)[0]].begins

    def _span(self, text: str) -> tuple[str, ...]:
        if not self.stages:
            raise TaskError(f"task {self.name!r} has no stages that can be run alone: its file names no STAGES")
        try:
            return span_of(self.stages, text)
        except CaretreeError as error:
            raise TaskError(f"task {self.name!r} has {error}") from error

    def scripted(self, seed: int) -> tuple[World, Senses | None]:
        """A scripted world for this task, and its scripted senses.

        Raises:
            TaskError: the file's own code fails, or its senses lack some that skills may ask for.
        """
        if self.script is None:
            return ScriptedWorld(seed=seed), None
        try:
            world, senses = self.script(seed)
        except (Exception, SystemExit) as error:
            raise TaskError(_located(self.file, error)) from error
        if senses is not None and not isinstance(senses, Senses):
            raise TaskError(f"{self.file}:1: scripted() gave {type(senses).__name__} as senses, which is no Senses")
        return world, senses

    def build(self, context: Context, **params: Any) -> Behaviour:
        """The tree, fresh.

        Raises:
            TaskError: the file's own code fails, or returns no tree.
            SettingError: the run sets a number that a skill of the tree does not have.
        """
        try:
            inspect.signature(self.function).bind(context, **params)
        except TypeError as error:
            raise TaskError(f"{self._line()}: task {self.name!r}: build(context, ...) {error}") from error
        try:
            root = self.function(context, **params)
        except SettingError:
            raise  # a mistake on the command line, not in the file
        except (Exception, SystemExit) as error:
            raise TaskError(_located(self.file, error)) from error
        if not isinstance(root, Behaviour):
            raise TaskError(f"{self._line()}: build() returned {type(root).__name__}, but a tree's root is asked for")
        return root

    def _line(self) -> str:
        code = getattr(self.function, "__code__", None)
        return f"{self.file}:{code.co_firstlineno if code else 1}"


def task_names() -> list[str]:
    """Names of the tasks that come with the package."""
    return sorted(info.name for info in pkgutil.iter_modules(tasks.__path__) if not info.name.startswith("_"))


def load_task(name: str) -> Task:
    """The task called `name`, or written in the file of that path.

    Raises:
        TaskError: there is none, or its file is broken.
    """
    path = Path(name)
    if path.suffix == ".py" or path.parent != Path("."):
        if (
            path.suffix == ".py"
            and path.stem in task_names()
            and _same_file(path, Path(tasks.__file__).parent / path.name)
        ):
            return load_task(path.stem)  # a task of the package, named by its path
        return _load_file(path)
    if name not in task_names():
        raise TaskError(f"unknown task {name!r}; there are {', '.join(task_names())}, or give the path of a .py file")
    module_name = f"{tasks.__name__}.{name}"
    spec = importlib.util.find_spec(module_name)
    file = _shown(Path(spec.origin)) if spec is not None and spec.origin else Path(f"{name}.py")
    try:
        module = importlib.import_module(module_name)
    except (Exception, SystemExit) as error:
        raise TaskError(_located(file, error)) from error
    return _task(name, module, file)


def _load_file(path: Path) -> Task:
    if not path.is_file():
        wrong = "is a folder, but a .py file is asked for" if path.is_dir() else "does not exist"
        raise TaskError(f"task file {path} {wrong}; named tasks are {', '.join(task_names())}")
    try:
        code = compile(path.read_text(encoding="utf-8"), str(path), "exec")
        module = ModuleType(f"caretree_task_{path.stem}")
        module.__file__, module.__package__ = str(path), ""
        folder = str(path.resolve().parent)
        if folder not in sys.path:
            sys.path.append(folder)  # a task may keep its skills in a file beside it
        sys.modules[module.__name__] = module  # dataclasses look their module up there
        exec(code, module.__dict__)  # running the user's own file is the point
    except (Exception, SystemExit) as error:
        raise TaskError(_located(path, error)) from error
    return _task(path.stem, module, path)


def _task(name: str, module: ModuleType, file: Path) -> Task:
    build = getattr(module, "build", None)
    if not callable(build):
        raise TaskError(f"{file}:1: a task needs a function build(context) that returns the tree")
    stages = getattr(module, "STAGES", {})
    if not isinstance(stages, Mapping) or not all(
        isinstance(key, str) and key.isidentifier() and isinstance(stage, TaskStage) for key, stage in stages.items()
    ):
        raise TaskError(f"{file}:1: STAGES is a dictionary of TaskStage by names of letters, digits and underscores")
    return Task(name, cast(Callable[..., Behaviour], build), file, getattr(module, "scripted", None), stages)


def _located(file: Path, error: Exception | SystemExit) -> str:
    """One sentence for an error of a task file, with the last line of that file it passed through."""
    if isinstance(error, SyntaxError) and error.filename and Path(error.filename).name == file.name:
        return f"{file}:{error.lineno or 1}: {error.msg}"
    lines = [
        frame.lineno
        for frame in traceback.extract_tb(error.__traceback__)
        if Path(frame.filename).name == file.name and frame.lineno
    ]
    text = str(error) if isinstance(error, CaretreeError) else f"{type(error).__name__}: {error}"
    if isinstance(error, ImportError) and "relative import" in text:
        text = "a task file imports by full names: `from caretree.skills...`, not `from ...skills...`"
    return f"{file}:{lines[-1] if lines else 1}: {text}"


def _same_file(path: Path, other: Path) -> bool:
    return path.exists() and other.exists() and path.samefile(other)


def _shown(path: Path) -> Path:
    """The path from here if it lies below, else as it is."""
    try:
        return path.relative_to(Path.cwd())
    except ValueError:
        return path
