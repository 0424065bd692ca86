"""What decides how a trial goes, in one hash: yesterday's trials do not count for today's task."""

from __future__ import annotations

import hashlib
import json
import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from ...sim.record.record import versions
from ..run.open_world import world_file
from ..run.task import Task

PACKAGE = Path(__file__).parents[2]
SHAPES_A_RUN = ("sim", "perception", "skills", "trees")
ONLY_TELLS = ("trees/campaign", "trees/commands", "trees/report", "trees/cli.py")  # of it afterwards, or starts it
SOURCES = (".py", ".xml")


def campaign_key(task: Task, arguments: Sequence[str], *, world: str | None = None) -> str:
    """Hash (hex) of all that two trials of one seed must share to be the same trial.

    It covers this package's sources, the task's own file and that of a world that the package does not bring, each
    with the files beside it that it names, the versions of packages, the arguments, and the files that these name.
    """
    digest = hashlib.sha256(json.dumps([task.name, list(arguments), versions()], sort_keys=True).encode())
    files = [*package_files(), *own_files(task.file)]
    if world and (brought := world_file(world)) is not None:
        installed = brought.resolve().is_relative_to(sys.prefix)  # among the packages, whose versions count
        files += [brought] if installed else own_files(brought)
    files += (Path(text) for text in arguments if Path(text).is_file())
    for file in files:
        digest.update(f"{file.name}\0".encode(errors="replace"))
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def package_files() -> list[Path]:
    """The sources of this package that shape a run."""
    found = [path for top in SHAPES_A_RUN for path in sorted((PACKAGE / top).rglob("*.py"))]
    return [path for path in found if not path.relative_to(PACKAGE).as_posix().startswith(ONLY_TELLS)]


def own_files(file: Path) -> list[Path]:
    """A user's task file, and those beside it whose names stand in it; none for a task of the package."""
    if not file.is_file() or file.resolve() in {path.resolve() for path in package_files()}:
        return []
    found = [file]
    for each in found:  # grows meanwhile
        words = set(re.findall(r"\w+", each.read_text(encoding="utf-8", errors="replace")))
        found += [beside for beside in _beside(file.parent, words) if beside not in found]
    return found


def _beside(folder: Path, words: set[str]) -> Iterator[Path]:
    for path in sorted(folder.iterdir()):
        if path.is_file() and path.suffix in SOURCES and path.stem in words:
            yield path
        elif path.name in words and (path / "__init__.py").is_file():
            yield from sorted(path.rglob("*.py"))
