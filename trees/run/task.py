"""Tasks by name, one file each: a module with `build(context, **params)` that returns the tree's root.

A module may also have

- `scripted(seed) -> (ScriptedWorld, Senses or None)`: the world on which `caretree check`, `caretree inject` and
  `--world scripted` try the task; where it takes `robot` too, it is given that of `--robot`;
- `STAGES`, a dictionary of `TaskStage` by name and in order: `--stage` then runs some of them alone, and `build` is
  given their names as `stages`;
- `BEGINS`, the name of the world's state in which the whole task begins, if not as usual;
- `senses(context) -> Senses`: what sees, unless the run was given others; called before `build`;
- `scene(world, seed)`, which furnishes the room before the run: `world.add(Box(...))`, `world.remove_gown()`;
- `judge(record) -> Judgement`, which decides from the truth of a run whether it reached its goal;
- `CONDITIONS`, the functions that its conditions ask, so that a tree in XML can name them.

Arguments of `build` that are declared as parameters (`parameters.py`) are set with `--set NAME=VALUE`.

A user's own file works the same: `caretree run path/to/task.py`; so does a tree in XML, `path/to/task.xml`.
"""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import sys
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import ModuleType
from typing import Any, cast

from py_trees.behaviour import Behaviour

from ...perception.senses import Senses
from ...sim.abilities import SupportsObjects
from ...sim.errors import CaretreeError
from ...sim.evaluate.run_record import Judgement, NotRecordedError, RunRecord
from ...sim.known_robots import robot_named
from ...sim.mechanics.robot_model import RobotModel
from ...sim.scripted.world import ScriptedWorld
from ...sim.world import World
from ...skills.core.context import Context
from ...skills.core.settings import SettingError
from .. import tasks
from ..btcpp.builder import Builder
from ..btcpp.document import XmlError
from ..btcpp.files import TreeFiles
from ..btcpp.vocabulary import Vocabulary
from ..tasks import task_names
from .parameters import BuildParameter, ParameterError, all_values, parameters_of
from .shape import ShapeError, check_shape
from .stages import TaskStage, span_of
from .time_limit import LOADING, TimeLimit, TookTooLongError

FROM_ITS_CODE = (Exception, SystemExit, GeneratorExit, TookTooLongError)  # what a task's own code may raise
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
        script: `scripted(seed)` or `scripted(seed, robot)` of its module, if it has one: the scripted world and senses
            to try it on.
        stages: by name and in order, if its module names any.
        senses: `senses(context)` of its module, if it has one.
        module: that it is written in, which has its own skills and conditions.
        scene: `scene(world, seed)` of its module, if it has one.
        judge: `judge(record)` of its module, if it has one.
        declared: parameters of `function`, by name.
        robot: to rehearse with; the usual one where that is None.
        begins: name of the world's state in which the whole task begins; empty where any will do.
    """

    name: str
    function: Callable[..., Behaviour]
    file: Path
    script: Callable[..., tuple[World, Senses | None]] | None = None
    stages: Mapping[str, TaskStage] = field(default_factory=dict)
    senses: Callable[[Context], Senses] | None = None
    module: ModuleType | None = None
    scene: Callable[[SupportsObjects, int], None] | None = None
    judge: Callable[[RunRecord], Judgement] | None = None
    declared: Mapping[str, BuildParameter] = field(default_factory=dict)
    robot: RobotModel | None = None
    begins: str = ""

    def values(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """The value of each parameter of the task: the given one, or its default.

        Raises:
            ParameterError: the task has no such parameter, or a value will not do.
        """
        return all_values(self.declared, given, self.name)

    def furnish(self, world: World, seed: int) -> None:
        """Let the task put its objects into a world that has not begun.

        Raises:
            TaskError: its scene fails, or this world takes no objects.
        """
        if self.scene is None:
            return
        if not isinstance(world, SupportsObjects):
            raise TaskError(f"task {self.name!r} brings a scene along, but {type(world).__name__} takes no objects")
        try:
            with TimeLimit(LOADING):
                self.scene(world, seed)
        except FROM_ITS_CODE as error:
            raise TaskError(_located(self.file, error)) from error

    def judged(self, directory: Path) -> Judgement:
        """What the task's own judge says of the record in `directory`.

        Raises:
            RecordError: the record lacks its truth, or is damaged.
            TaskError: there is no judge, its code fails, or it returns something else.
        """
        if self.judge is None:
            raise TaskError(f"{self.file}:1: task {self.name!r} has no judge(record)")
        record = RunRecord(directory)
        try:
            with TimeLimit(LOADING):
                found = self.judge(record)
        except NotRecordedError:
            raise
        except FROM_ITS_CODE as error:
            raise TaskError(_located(self.file, error)) from error
        if not isinstance(found, Judgement):
            raise TaskError(f"{self.file}:1: judge() returned {type(found).__name__}, but a Judgement is asked for")
        return found

    def parameters(self, stage: str | None) -> dict[str, Any]:
        """What `build` is given to run a stage or a span of them alone; nothing for the whole task (None).

        Raises:
            TaskError: the task has no such stage.
        """
        return {} if stage is None else {"stages": self._span(stage)}

    def initial_state(self, stage: str | None) -> str:
        """Name of the world's state in which a stage, a span of them or the whole task (None) begins; empty for any.

        Raises:
            TaskError: the task has no such stage.
        """
        return self.begins if stage is None else self.stages[self._span(stage)[0]].begins

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
        chosen: dict[str, Any] = {} if self.robot is None else {"robot": self.robot}
        if self.script is None:
            world, senses = ScriptedWorld(seed=seed, **chosen), None
        else:
            if chosen and "robot" not in inspect.signature(self.script).parameters:
                raise TaskError(f"task {self.name!r} has its own robot: its scripted(seed) takes none")
            try:
                with TimeLimit(LOADING):
                    made: Any = self.script(seed, **chosen)
            except FROM_ITS_CODE as error:
                raise TaskError(_located(self.file, error)) from error
            if not (isinstance(made, tuple) and len(made) == 2):
                raise TaskError(f"{self.file}:1: scripted() gave {type(made).__name__}, not (world, senses or None)")
            world, senses = made
        self.furnish(world, seed)
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
            with TimeLimit(LOADING):
                if self.senses is not None:
                    context.offer_senses(self.senses(context))
                root = self.function(context, **params)
        except (SettingError, XmlError):
            raise  # a mistake on the command line, or one that says its own line
        except FROM_ITS_CODE as error:
            raise TaskError(_located(self.file, error)) from error
        if not isinstance(root, Behaviour):
            raise TaskError(f"{self._line()}: build() returned {type(root).__name__}, but a tree's root is asked for")
        try:
            check_shape(root)
        except ShapeError as error:
            raise TaskError(f"{self._line()}: build() returned no tree: {error}") from error
        return root

    def _line(self) -> str:
        return f"{self.file}:{_first_line(self.function)}"


def load_task(name: str, *, robot: str | None = None) -> Task:
    """The task called `name`, or written in the file of that path, to be rehearsed with the robot of a name.

    Raises:
        TaskError: there is none, or its file is broken.
        RobotError: there is no such robot, or it is none that skills can move.
    """
    task = _load(name)
    return task if robot is None else replace(task, robot=robot_named(robot))


def _load(name: str) -> Task:
    path = Path(name)
    if path.suffix == ".xml":
        return _load_xml(path)
    if path.suffix == ".py" or path.parent != Path("."):
        if (
            path.suffix == ".py"
            and path.stem in task_names()
            and _same_file(path, Path(tasks.__file__).parent / path.name)
        ):
            return load_task(path.stem)  # a task of the package, named by its path
        return _load_file(path)
    if name not in task_names():
        raise TaskError(
            f"unknown task {name!r}; there are {', '.join(task_names())}, or give the path of a .py or .xml file"
        )
    return _task(name, *_named_module(name))


def _named_module(name: str) -> tuple[ModuleType, Path]:
    """The module of a task of the package, and its file."""
    module_name = f"{tasks.__name__}.{name}"
    spec = importlib.util.find_spec(module_name)
    file = _shown(Path(spec.origin)) if spec is not None and spec.origin else Path(f"{name}.py")
    try:
        return importlib.import_module(module_name), file
    except FROM_ITS_CODE as error:
        raise TaskError(_located(file, error)) from error


def _load_xml(path: Path) -> Task:
    """A tree in XML: skills, conditions, senses and scripted world come from the Python that it names, if any."""
    files = TreeFiles(path)
    modules = [
        _named_module(each.name)[0] if each.name in task_names() else _module_at(each.path()) for each in files.python
    ]
    vocabulary = Vocabulary.of(modules)

    def build(context: Context) -> Behaviour:
        return Builder(files, vocabulary, context).build()

    first = modules[0] if modules else None
    script, senses, scene, judge = (getattr(first, name, None) for name in ("scripted", "senses", "scene", "judge"))
    begins = getattr(first, "BEGINS", "")
    return Task(path.stem, build, path, script, senses=senses, module=first, scene=scene, judge=judge, begins=begins)


def _load_file(path: Path) -> Task:
    return _task(path.stem, _module_at(path), path)


def _module_at(path: Path) -> ModuleType:
    """A task file, run as a module."""
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
        with TimeLimit(LOADING):
            exec(code, module.__dict__)  # running the user's own file is the point
    except FROM_ITS_CODE as error:
        raise TaskError(_located(path, error)) from error
    return module


def _task(name: str, module: ModuleType, file: Path) -> Task:
    build = getattr(module, "build", None)
    if not callable(build):
        raise TaskError(f"{file}:1: a task needs a function build(context) that returns the tree")
    stages = getattr(module, "STAGES", {})
    if not isinstance(stages, Mapping) or not all(
        isinstance(key, str) and key.isidentifier() and isinstance(stage, TaskStage) for key, stage in stages.items()
    ):
        raise TaskError(f"{file}:1: STAGES is a dictionary of TaskStage by names of letters, digits and underscores")
    begins = getattr(module, "BEGINS", "")
    if not isinstance(begins, str):
        raise TaskError(f"{file}:1: BEGINS is the name of a state of the world, not {type(begins).__name__}")
    function = cast(Callable[..., Behaviour], build)
    for brought, arguments in (("scene", ("world", "seed")), ("judge", ("record",)), ("scripted", ("seed",))):
        _check_callable(module, brought, arguments, file)
    try:
        declared = parameters_of(function)
    except ParameterError as error:
        raise TaskError(f"{file}:{_first_line(function)}: {error}") from error
    return Task(
        name,
        function,
        file,
        getattr(module, "scripted", None),
        stages,
        getattr(module, "senses", None),
        module,
        getattr(module, "scene", None),
        getattr(module, "judge", None),
        declared,
        begins=begins,
    )


def _check_callable(module: ModuleType, name: str, arguments: tuple[str, ...], file: Path) -> None:
    """Refuse a part of a task that cannot be called as it will be."""
    found = getattr(module, name, None)
    if found is None:
        return
    asked = f"{name}({', '.join(arguments)})"
    if not callable(found):
        raise TaskError(f"{file}:1: {name} is a {type(found).__name__}, but a function {asked} is asked for")
    try:
        inspect.signature(found).bind(*arguments)
    except TypeError as error:
        raise TaskError(f"{file}:{_first_line(found)}: {asked} is called, but: {error}") from error


def _first_line(function: Callable[..., Any]) -> int:
    code = getattr(function, "__code__", None)
    return code.co_firstlineno if code else 1


def _located(file: Path, error: BaseException) -> str:
    """One sentence for an error of a task file, with the last line of that file it passed through."""
    if isinstance(error, SyntaxError) and error.filename and Path(error.filename).name == file.name:
        return f"{file}:{error.lineno or 1}: {error.msg}"
    lines = [
        frame.lineno
        for frame in traceback.extract_tb(error.__traceback__)
        if Path(frame.filename).name == file.name and frame.lineno
    ]
    text = str(error) if isinstance(error, (CaretreeError, TookTooLongError)) else f"{type(error).__name__}: {error}"
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
