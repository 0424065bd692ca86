"""`caretree new TASK`: a task file that runs as it is, with its scripted world and its test, to be made one's own."""

from __future__ import annotations

import argparse
import importlib.util
import keyword
import shlex
from pathlib import Path

from ...sim.errors import CaretreeError
from ..tasks import task_names

FILES = {"{name}.py": "task.txt", "test_{name}.py": "test_task.txt"}  # what is written -> of which text
STANDS_FOR_NAME = "TASK_NAME"


def main(options: argparse.Namespace) -> int:
    """Write the files and say what to do next.

    Raises:
        CaretreeError: the name will not do, or a file of that name is there.
    """
    written = write_task(options.name, Path(options.out))
    for path in written:
        print(path)
    print(f"next: caretree run {shlex.quote(str(written[0]))} --world scripted")
    return 0


def write_task(name: str, folder: Path) -> list[Path]:
    """Write a new task `name` into `folder` and return the files, the task first.

    Raises:
        CaretreeError: the name will not do, or a file of that name is there.
    """
    plain = name.isascii() and name.isidentifier() and not keyword.iskeyword(name)
    if not plain or name.startswith(("_", "test_")):
        raise CaretreeError(f"{name!r} is no name for a task: a Python name such as fetch_gown is asked for")
    if name in task_names():
        raise CaretreeError(f"{name!r} is a task of the package already; give another name")
    files = {folder / file.format(name=name): text for file, text in FILES.items()}
    if there := [path for path in files if path.exists()]:
        raise CaretreeError(f"{there[0]} is there already; give another name, or another folder with --out")
    if importlib.util.find_spec(name) is not None:
        raise CaretreeError(f"{name}.py would stand in the way of Python's module {name!r}; give another name")
    if folder.exists() and not folder.is_dir():
        raise CaretreeError(f"--out is {folder}, which is a file; a folder is asked for")
    folder.mkdir(parents=True, exist_ok=True)
    texts = Path(__file__).parents[1] / "skeleton"
    for path, text in files.items():
        path.write_text(
            (texts / text).read_text(encoding="utf-8").replace(STANDS_FOR_NAME, name), encoding="utf-8", newline="\n"
        )
    return list(files)
