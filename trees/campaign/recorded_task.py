"""Which task a record is of: its file is found from wherever it is asked about, and told where it is another by now."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..run.task import Task, TaskError, load_task
from .key import own_files

FILE, HASH = "task_file", "task_hash"  # among the parameters of a record


def noted(task: Task) -> dict[str, str]:
    """What a record has to say of a user's task file, to find it again; nothing for a task of the package."""
    files = own_files(task.file)
    return {FILE: str(task.file.resolve()), HASH: _hash(files)} if files else {}


def recorded_task(name: str, parameters: Mapping[str, Any], *, robot: str | None = None) -> tuple[Task, str]:
    """The task that a record names, and one sentence where its file, or one beside it, has been changed since.

    Args:
        name: of the task, or path of its file as it was typed.
        parameters: of the record.
        robot: to rehearse with.

    Raises:
        TaskError: it is not where it was, nor where it would be seen from here, or it is broken.
    """
    where, then = parameters.get(FILE), parameters.get(HASH)
    if not isinstance(where, str):
        return load_task(name, robot=robot), ""
    path = next((each for each in (where, name) if Path(each).is_file()), None)
    if path is None:
        raise TaskError(f"the task file of this record is not at {where} any more, nor is there {name} from here")
    task = load_task(path, robot=robot)
    changed = "" if _hash(own_files(task.file)) == then else f"task file {path} has been changed since"
    return task, changed


def _hash(files: list[Path]) -> str:
    digest = hashlib.sha256()
    for file in files:
        digest.update(f"{file.name}\0".encode(errors="replace"))
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]
