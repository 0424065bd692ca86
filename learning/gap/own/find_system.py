"""Where a user's `System` comes from: a class in a file of theirs, or an installed entry point."""

from __future__ import annotations

import importlib.util
import sys
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any

from ..errors import GapError
from .system import System, check_system

GROUP = "caretree.gap_systems"


def installed() -> dict[str, EntryPoint]:
    """Name -> entry point of every system that installed packages offer."""
    return {entry.name: entry for entry in entry_points(group=GROUP)}


def find_system(where: str) -> System:
    """The system behind `path.py:Class` or the name of an entry point.

    Raises:
        GapError: there is none, it cannot be imported or constructed, or it is no usable System.
    """
    if ":" in where or where.endswith(".py"):
        return made(_from_file(where), where)
    known = installed()
    if where not in known:
        names = ", ".join(sorted(known)) or "none is installed"
        raise GapError(f"--system is {where!r}, it must be path.py:Class or one of the group {GROUP} ({names})")
    try:
        return made(known[where].load(), where)
    except GapError:
        raise
    except Exception as error:  # whatever a stranger's module raises while it is imported
        raise GapError(f"system {where}: {_one_line(error)}") from None


def absolute(where: str) -> str:
    """`path.py:Class` with the whole path, as later steps may be run from elsewhere; an entry point's name as it is."""
    path, colon, name = where.rpartition(":")
    return f"{Path(path).expanduser().resolve()}:{name}" if colon else where


def made(kind: Any, where: str) -> System:
    """An instance of a user's class, checked.

    Raises:
        GapError: it is no System, or its constructor fails.
    """
    if not (isinstance(kind, type) and issubclass(kind, System)):
        raise GapError(f"{where}: {kind!r:.60} is no class that derives from caretree.gap.System")
    lacking = sorted(getattr(kind, "__abstractmethods__", ()))
    if lacking:
        raise GapError(f"{where}: {kind.__name__} has no {' and no '.join(lacking)}")
    try:
        system = kind()
    except Exception as error:
        raise GapError(f"{where}: {kind.__name__}() failed: {_one_line(error)}") from None
    return check_system(system)


def _from_file(where: str) -> Any:
    text, _, name = where.rpartition(":")
    path = Path(text or where).expanduser()
    if not text or not name or path.suffix != ".py":
        raise GapError(f"--system is {where!r}, it must be path.py:Class")
    if not path.is_file():
        raise GapError(f"{path}: no such file")
    module_name = f"caretree_own_{path.stem}"
    spec = importlib.util.spec_from_file_location(module_name, path)
    if spec is None or spec.loader is None:
        raise GapError(f"{path}: cannot be imported")
    module = importlib.util.module_from_spec(spec)
    sys.modules[module_name] = module  # dataclasses look their module up
    try:
        spec.loader.exec_module(module)
    except Exception as error:  # whatever a user's file raises
        raise GapError(f"{path}: {_one_line(error)}") from None
    if not hasattr(module, name):
        kinds = [
            k for k, v in vars(module).items() if isinstance(v, type) and issubclass(v, System) and v is not System
        ]
        raise GapError(f"{path}: there is no class {name} (there are {', '.join(kinds) or 'none that are a System'})")
    return getattr(module, name)


def _one_line(error: Exception) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())[:200]}"
