"""`caretree completion bash|zsh`: a script that completes commands, options, tasks, skills and files in that shell.

The words are those of the parsers and folders of this version; nothing is run while the user types.
"""

from __future__ import annotations

import argparse
import pkgutil
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from ... import skills
from ...sim.known_robots import ROBOTS
from ..cli import DELEGATED, ENGINES, FAULTS, GOWNS, LOOKS, PERSONS, SELF_PARSED, WORLD_KINDS, WORLDS, build_parser
from ..tasks import task_names

Paths = Literal["", "tasks", "files", "folders"]
PATHS: dict[str, Paths] = {"": "", "TASK": "tasks", "FILE": "files", "DIR": "folders"}  # by what help calls the value
NAMED = {
    "--gown": GOWNS,
    "--person": PERSONS,
    "--look": LOOKS,
    "--world": ", ".join(WORLDS),
    "--world-kind": WORLD_KINDS,
    "--fault": FAULTS,
    "--engine": ENGINES,
    "--robot": ", ".join(ROBOTS),
}
BASH_PATHS: dict[Paths, tuple[str, ...]] = {
    "": (),
    "tasks": ("-f -X '!*.py'", "-f -X '!*.xml'", "-d"),
    "files": ("-f",),
    "folders": ("-d",),
}
ZSH_PATHS: dict[Paths, tuple[str, ...]] = {
    "": (),
    "tasks": ("_files -g '*.(py|xml)'",),
    "files": ("_files",),
    "folders": ("_files -/",),
}

BASH = """# caretree in bash: put  eval "$(caretree completion bash)"  into ~/.bashrc
_caretree() {{
    local word="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" command="${{COMP_WORDS[1]}}"
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
{commands}
        return
    fi
    case "$command $before" in
{values}
    esac
    case "$word" in
        -*) case "$command" in
{options}
        esac ;;
        *) case "$command" in
{places}
        esac ;;
    esac
}}
complete -o filenames -F _caretree caretree
"""
ZSH = """#compdef caretree
# caretree in zsh: put  eval "$(caretree completion zsh)"  into ~/.zshrc, behind compinit
_caretree() {{
    local before=${{words[CURRENT-1]}} command=${{words[2]}}
    if (( CURRENT == 2 )); then
{commands}
        return
    fi
    case "$command $before" in
{values}
    esac
    case ${{words[CURRENT]}} in
        -*) case $command in
{options}
        esac ;;
        *) case $command in
{places}
        esac ;;
    esac
}}
compdef _caretree caretree
"""


@dataclass(frozen=True)
class Offer:
    """What may stand in one place: words, and files of a kind."""

    words: tuple[str, ...] = ()
    paths: Paths = ""


@dataclass(frozen=True)
class CommandWords:
    """What one command takes.

    Attributes:
        options: by name, what their value may be; None for one without a value.
        places: what may stand where no option does.
    """

    options: dict[str, Offer | None]
    places: Offer


def main(options: argparse.Namespace) -> int:
    """Print the script."""
    print(script(options.shell), end="")
    return 0


def script(shell: str) -> str:
    """The script for `shell`, bash or zsh."""
    template, add = (BASH, _bash) if shell == "bash" else (ZSH, _zsh)
    commands = words()
    values = [
        f'        "{name} {option}") {"; ".join(add(offer))}; return ;;'
        for name, command in commands.items()
        for option, offer in command.options.items()
        if offer is not None and add(offer)
    ]
    options = [
        f"            {name}) {add(Offer(tuple(command.options)))[0]} ;;"
        for name, command in commands.items()
        if command.options
    ]
    places = [
        f"            {name}) {'; '.join(add(command.places))} ;;"
        for name, command in commands.items()
        if add(command.places)
    ]
    return template.format(
        commands=f"        {add(Offer((*commands, '--help', '--version')))[0]}",
        values="\n".join(values),
        options="\n".join(options),
        places="\n".join(places),
    )


def words() -> dict[str, CommandWords]:
    """What each command takes, by its name."""
    found = _parsers("")
    for name in SELF_PARSED:
        found[name] = _parsers(name)[name]
    return {name: CommandWords(_options(parser), _places(name, parser)) for name, parser in sorted(found.items())}


def _parsers(command: str) -> dict[str, argparse.ArgumentParser]:
    for action in build_parser(command)._actions:
        if isinstance(action, argparse._SubParsersAction):
            return dict(action.choices)
    return {}


def _actions(parser: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    """What the parser takes, and what its forms take, as of `export`."""
    for action in parser._actions:
        yield action
        if isinstance(action, argparse._SubParsersAction):
            for form in action.choices.values():
                yield from _actions(form)


def _options(parser: argparse.ArgumentParser) -> dict[str, Offer | None]:
    return {
        option: None if action.nargs == 0 else _offer(action)
        for action in _actions(parser)
        for option in action.option_strings
        if option.startswith("--")
    }


def _offer(action: argparse.Action) -> Offer:
    for option in action.option_strings:
        if option in NAMED:
            return Offer(tuple(NAMED[option].split(", ")), "files" if option == "--gown" else "")
    return Offer(tuple(map(str, action.choices or ())), PATHS.get(str(action.metavar), ""))


def _places(name: str, parser: argparse.ArgumentParser) -> Offer:
    if name == "new":
        return Offer()  # a name that there is not yet
    if name in DELEGATED:
        return Offer(paths="files")  # they parse their own words
    taken = [action for action in _actions(parser) if not action.option_strings]
    said = [str(word) for action in taken for word in action.choices or ()]
    kinds: list[Paths] = [kind for action in taken if (kind := PATHS.get(str(action.metavar)))]
    paths: Paths = kinds[0] if kinds else ""
    said += task_names() if paths == "tasks" else []
    if name == "skills":
        said += [info.name for info in pkgutil.iter_modules(skills.__path__) if not info.ispkg]
    return Offer(tuple(said), paths)


def _bash(offer: Offer) -> list[str]:
    kinds = [f'-W "{" ".join(offer.words)}"'] if offer.words else []
    return [f'COMPREPLY+=($(compgen {kind} -- "$word"))' for kind in (*kinds, *BASH_PATHS[offer.paths])]


def _zsh(offer: Offer) -> list[str]:
    return [*([f"compadd -- {' '.join(offer.words)}"] if offer.words else []), *ZSH_PATHS[offer.paths]]
