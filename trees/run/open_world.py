"""Worlds that the package does not bring: named by their class, by a file, or by an entry point of another package.

    --world my_robot.world:MyRobot      a class that Python can import, from the present folder too
    --world lab/my_robot.py:MyRobot     a class in a file
    --world my_robot                    what an installed package calls so in its entry points `caretree.worlds`

What the class takes with a simple type is set with `--world-arg NAME=VALUE`; `seed`, where it takes one, is the run's.
Nothing is imported before a world is asked for.
"""

from __future__ import annotations

import difflib
import importlib
import importlib.util
import inspect
import sys
from collections.abc import Callable, Mapping, Sequence
from importlib import metadata
from pathlib import Path
from types import ModuleType, UnionType
from typing import TYPE_CHECKING, Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from ...sim.blame import OF_FOREIGN_CODE, told
from ...sim.errors import CaretreeError
from ...sim.extras import later, missing_extra
from ...sim.mechanics.robot_model import RobotModel
from ...sim.world import RoomMap, World
from ...sim.yaml_text import load_yaml
from .parameters import PLAIN, BuildParameter, Parameter, ParameterError
from .time_limit import LOADING, TimeLimit, TookTooLongError

if TYPE_CHECKING:
    import yaml
else:
    yaml = later("yaml")

GROUP = "caretree.worlds"
OWN = {  # made like any other
    "remote": "caretree.sim.remote.world:RemoteWorld",
    "ros1": "caretree.sim.ros1.world:Ros1World",
}
EXTRA = {"remote": "remote", "ros1": "ros"}  # of these
HOW = "or give package.module:Class or file.py:Class"
FROM_ITS_CODE = (*OF_FOREIGN_CODE, TookTooLongError)
REQUIRED: Any = inspect.Parameter.empty


class OpenWorld:
    """A world of somebody else, found but not yet made.

    Args:
        name: as on the command line.

    Attributes:
        options: what `--world-arg` may set, by name; where `default` is `REQUIRED`, it has to be.

    Raises:
        CaretreeError: there is none of that name, its code fails, or it takes what no command line can give.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self._make = _loaded(name)
        try:
            signature = inspect.signature(self._make)
            hints = get_type_hints(_annotated(self._make), include_extras=True)
        except (NameError, TypeError, ValueError, AttributeError) as error:
            raise CaretreeError(f"what world {name} takes cannot be read: {error}") from error
        arguments = [each for each in signature.parameters.values() if each.kind not in (each.VAR_POSITIONAL,)]
        self._seeded = any(each.name == "seed" for each in arguments)
        self.options: dict[str, BuildParameter] = {}
        for each in arguments:
            if each.name == "seed" or each.kind == each.VAR_KEYWORD:
                continue
            kind, declared = _kind(hints.get(each.name))
            if kind is not None and each.kind != each.POSITIONAL_ONLY:
                self.options[each.name] = BuildParameter(each.name, kind, each.default, declared)
            elif each.default is REQUIRED:
                raise CaretreeError(
                    f"world {name} takes {each.name}, which --world-arg cannot give: it takes float, int, bool, str, "
                    "Path and Literal"
                )

    def read(self, texts: Sequence[str]) -> dict[str, Any]:
        """The values written in `texts`, NAME=VALUE each.

        Raises:
            CaretreeError: a text does not have that form, or `check` refuses a value.
        """
        given: dict[str, Any] = {}
        for text in texts:
            name, equals, value = text.partition("=")
            name = name.strip()
            if not (equals and name):
                raise CaretreeError(f"--world-arg is {text!r}, but NAME=VALUE is asked for; {self._there()}")
            option = self.options.get(name)
            if option is not None and option.kind is str:
                given[name] = value
                continue
            try:
                given[name] = load_yaml(value)
            except yaml.YAMLError:
                raise CaretreeError(f"--world-arg {name}: {value!r} is no value") from None
        return self.check(given)

    def check(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """`given` by name, each with the type that its option has.

        Raises:
            CaretreeError: there is no such option, a value will not do, or a required one is missing.
        """
        for name in given:
            if name not in self.options:
                alike = difflib.get_close_matches(name, list(self.options), n=1)
                meant = f"; {alike[0]} is meant?" if alike else ""
                raise CaretreeError(f"--world-arg {name}: {self._there()}{meant}")
        missing = [each for each in self.options.values() if each.default is REQUIRED and each.name not in given]
        if missing:
            raise CaretreeError(f"world {self.name} needs --world-arg {missing[0].name}=, {missing[0].asked()}")
        try:
            return {name: self.options[name].value(value) for name, value in given.items()}
        except ParameterError as error:
            raise CaretreeError(f"--world-arg: {error}") from error

    def make(self, seed: int, given: Mapping[str, Any]) -> World:
        """The world.

        Raises:
            CaretreeError: a value will not do, its own code fails, or what it makes is no World.
        """
        values: dict[str, Any] = self.check(given)
        if self._seeded:
            values["seed"] = seed
        try:
            with TimeLimit(LOADING):
                world = self._make(**values)
        except CaretreeError:
            raise  # a sentence of its own
        except FROM_ITS_CODE as error:
            raise CaretreeError(f"world {self.name} cannot be made: {_said(error)}") from error
        if not isinstance(world, World):
            raise CaretreeError(f"world {self.name} makes a {type(world).__name__}, but a World is asked for")
        if not isinstance(getattr(world, "robot", None), RobotModel):
            raise CaretreeError(
                f"world {self.name} does not say what its robot is made of: its `robot` has to be a RobotModel, for "
                "instance caretree.sim.known_robots.robot_named('baxter')"
            )
        for what in ("clock", "room"):
            if (fault := _lacking(world, what)) is not None:
                raise CaretreeError(f"world {self.name} {fault}")
        return world

    def _there(self) -> str:
        lines = [f"{each.name} ({each.asked()})" for each in self.options.values()]
        return f"world {self.name} takes {', '.join(lines) or 'nothing'}"


def installed_worlds() -> dict[str, str]:
    """What this package and other installed ones offer: name -> `package.module:Class`."""
    return OWN | {entry.name: entry.value for entry in metadata.entry_points(group=GROUP)}


def world_file(name: str) -> Path | None:
    """The file in which a world of that name is written; None where none is found."""
    place, colon, _ = installed_worlds().get(name, name).partition(":")
    if not colon:
        return None
    if place.endswith(".py"):
        return Path(place) if Path(place).is_file() else None
    _reach_present_folder()
    try:
        spec = importlib.util.find_spec(place)
    except (ImportError, ValueError, AttributeError):
        return None
    return Path(spec.origin) if spec is not None and spec.origin and Path(spec.origin).is_file() else None


def _loaded(name: str) -> Callable[..., Any]:
    """What makes the world called `name`."""
    place, colon, attribute = installed_worlds().get(name, name).partition(":")
    if not (place and colon and attribute):
        raise CaretreeError(f"world {name!r} is not written package.module:Class or file.py:Class")
    try:
        with TimeLimit(LOADING):
            module = _module_in(Path(place)) if place.endswith(".py") else _module_called(place)
    except FROM_ITS_CODE as error:
        if isinstance(error, ModuleNotFoundError) and (missing := missing_extra(error, EXTRA.get(name))) is not None:
            raise missing from error
        raise CaretreeError(f"world {name} cannot be loaded: {_said(error)}") from error
    made: Any = module
    for part in attribute.split("."):
        made = getattr(made, part, None)
    if not callable(made):
        kinds = [key for key, value in vars(module).items() if isinstance(value, type) and issubclass(value, World)]
        own = [key for key in kinds if vars(module)[key].__module__ == module.__name__]
        raise CaretreeError(f"{place} has no class {attribute}; its worlds are {', '.join(own) or 'none'}")
    return made


def _module_called(name: str) -> ModuleType:
    _reach_present_folder()
    return importlib.import_module(name)


def _reach_present_folder() -> None:
    """A world may lie in the folder where the command is given."""
    if "" not in sys.path and str(Path.cwd()) not in sys.path:
        sys.path.append(str(Path.cwd()))


def _module_in(path: Path) -> ModuleType:
    if not path.is_file():
        raise FileNotFoundError(f"there is no file {path}")
    name = f"caretree_world_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None  # as it ends in .py
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    folder = str(path.resolve().parent)
    if folder not in sys.path:
        sys.path.append(folder)  # a world may keep what it needs in a file beside it
    sys.modules[name] = module  # dataclasses look their module up there
    spec.loader.exec_module(module)
    return module


def _annotated(make: Callable[..., Any]) -> Any:
    """Where the types of its arguments are written."""
    return make.__init__ if isinstance(make, type) else make


def _kind(hint: Any) -> tuple[type | tuple[Any, ...] | None, Parameter]:
    """What `BuildParameter` calls the kind of an annotation, None where it has none; and its declaration."""
    declared = Parameter("")
    if get_origin(hint) is Annotated:
        declared = next((each for each in get_args(hint)[1:] if isinstance(each, Parameter)), declared)
        hint = get_args(hint)[0]
    if get_origin(hint) in (Union, UnionType):
        left = [each for each in get_args(hint) if each is not type(None)]
        # a path may be given as text, whatever else is taken
        hint = str if str in left else left[0] if len(left) == 1 else None
    if get_origin(hint) is Literal:
        return get_args(hint), declared
    if hint is Path:
        return str, declared
    return (hint, declared) if hint in PLAIN else (None, declared)


def _lacking(world: World, what: str) -> str | None:
    """What a world has forgotten of its contract, `clock` or `room`; None where it has it."""
    found = getattr(world, what, None)
    if what == "room" and not isinstance(found, RoomMap):
        return (
            "has no map: its `room` has to be a RoomMap, for instance caretree.sim.scripted.world.scripted_room(), but "
            f"is {_kind_of(found)}"
        )
    if what == "clock":
        lacks = [name for name in ("now", "wait_until") if not callable(getattr(found, name, None))]
        if lacks:
            return (
                f"has no clock: its `clock` has to have now() and wait_until(time), but is {_kind_of(found)} without "
                f"{' and '.join(lacks)}"
            )
    return None


def _kind_of(found: object) -> str:
    return "None" if found is None else f"a {type(found).__name__}"


def _said(error: BaseException) -> str:
    """One clause for an error of somebody else's code, with the place it came from."""
    return str(error) if isinstance(error, TookTooLongError) else told(error)  # which names its place itself
