"""`caretree learn physics`: each command lives in a module that is read only when it is called."""

from __future__ import annotations

import importlib
import importlib.util

from ...sim.errors import CaretreeError

COMMANDS = {  # command -> (module with `main(argv) -> int`, argv with the command in front; what it does)
    "data": (".data_cli", "make a dataset of clips, or what is missing of it"),
    "clip": (".data_cli", "render the clip of one falling gown and write it"),
    "show": (".data_cli", "draw filmstrips of clips"),
    "sensitivity": (".data_cli", "what a clip shows of each parameter"),
    "train": (".learn_cli", "train a method"),
    "evaluate": (".learn_cli", "errors of each method"),
    "pictures": (".learn_cli", "t-SNE, box plots and filmstrips of a study"),
    "identify": (".learn_cli", "parameters with intervals from one clip; writes a gown file"),
}


def usage() -> str:
    """The help text."""
    lines = [f"  {name:<12} {text}" for name, (_, text) in COMMANDS.items()]
    return "\n".join(["usage: caretree learn physics COMMAND ...", "", "commands:", *lines])


def main(argv: list[str]) -> int:
    """Run one command; 0 when all went well.

    Raises:
        CaretreeError: no such command, or one that this version lacks.
    """
    if not argv or argv[0] in ("-h", "--help"):
        print(usage())
        return 0
    if argv[0] not in COMMANDS:
        raise CaretreeError(f"`caretree learn physics` has no command '{argv[0]}', it has {', '.join(COMMANDS)}")
    module = COMMANDS[argv[0]][0]
    if importlib.util.find_spec(module, __package__) is None:
        raise CaretreeError(f"`caretree learn physics {argv[0]}` is not in this version")
    return int(importlib.import_module(module, __package__).main(argv) or 0)
