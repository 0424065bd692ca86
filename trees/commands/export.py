"""`caretree export`: a task's tree, or what robots did, for other programs.

caretree export xml TASK           # BehaviorTree.CPP 4 and Groot2 read it; `caretree run` reads it too
caretree export lerobot RECORD...  # a LeRobot dataset of the logs of runs
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from ...sim.errors import CaretreeError
from ...skills.core.context import Context
from ..btcpp.vocabulary import Vocabulary
from ..btcpp.writer import written
from ..guard.guard import GuardedWorld
from ..run.task import Task, TaskError, load_task
from ..tasks import task_names
from . import export_lerobot


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the command line."""
    parser = subparsers.add_parser("export", help="write a task's tree, or what robots did, for other programs")
    forms = parser.add_subparsers(dest="form", metavar="FORM", required=True)
    xml = forms.add_parser("xml", help="a task's tree: BehaviorTree.CPP 4, Groot2")
    xml.add_argument("task", metavar="TASK", help="name of a task, or path of a task file")
    xml.add_argument("--stage", metavar="NAME", help="this stage alone, or a span such as dress-spread")
    xml.add_argument("--out", metavar="FILE", help="file to write (default: print it)")
    xml.set_defaults(main=main)
    export_lerobot.add_parser(forms)


def main(options: argparse.Namespace) -> int:
    """Print the tree's file, or write it.

    Raises:
        CaretreeError: the task is unknown or broken, or holds what XML cannot, or the file is no tree in XML.
    """
    task = load_task(options.task)
    out = Path(options.out) if options.out else None
    if out is not None and out.exists() and out.suffix != ".xml":
        raise CaretreeError(f"{out} is there already, and is no .xml: give another file with --out")
    text = exported(task, folder=out.parent if out else Path(), stage=options.stage)
    if out is None:
        print(text, end="")
        return 0
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(text, encoding="utf-8", newline="\n")
    print(out)
    return 0


def exported(task: Task, *, folder: Path, stage: str | None = None) -> str:
    """The task's tree in XML.

    Args:
        task: to write.
        folder: that the file will lie in; the task's own file is named from there.
        stage: to be written alone, or a span of them; None for the whole task.

    Raises:
        CaretreeError: the task cannot be built, or holds what XML cannot.
    """
    world, _ = task.scripted(0)
    guard = GuardedWorld(world)
    context = Context(world=guard, guard=guard)
    root = task.build(context, **task.parameters(stage))
    if task.senses is None and context.has_senses:
        raise TaskError(
            f"{task.file}:1: build() offers senses, which XML cannot: return them from a function senses(context)"
        )
    modules = [task.module] if task.module else []
    return written(root, Vocabulary.of(modules), _python_of(task, folder))


def _python_of(task: Task, folder: Path) -> str:
    """How a file in `folder` names the Python of a task: a task of the package by its name, another by its path."""
    if task.module is None:
        return ""
    name = task.module.__name__.rpartition(".")[2]
    if task.module.__package__ and name in task_names():
        return name
    if not task.module.__file__:
        raise CaretreeError(f"task {task.name!r} has no file that its tree could name")
    return Path(os.path.relpath(Path(task.module.__file__).resolve(), folder.resolve())).as_posix()
