"""Numbers of skills and parameters of the task, from the command line and from a tuning file.

`--set SKILL.NUMBER=VALUE` sets a number of a skill, `--set NAME=VALUE` a parameter of the task; a file holds both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...sim.errors import CaretreeError
from ...sim.extras import later
from ...sim.yaml_text import load_yaml
from ...skills.core.settings import Settings

if TYPE_CHECKING:
    import yaml
else:
    yaml = later("yaml")


@dataclass(frozen=True)
class Given:
    """What a run is given in numbers.

    Attributes:
        settings: of skills.
        parameters: of the task, name -> value, as it was written.
    """

    settings: Settings = field(default_factory=Settings)
    parameters: dict[str, Any] = field(default_factory=dict)


def read_given(assignments: Sequence[str], file: str | None = None) -> Given:
    """What `file` sets, with what `assignments` set in its place where both name one.

    Args:
        assignments: `present_sleeve.max_load=3.5`, `seconds=8`; a value is written as in YAML: `3.5`, `true`,
            `[0.1, 0.2]`.
        file: YAML: skill -> number -> value, and parameter -> value.

    Raises:
        CaretreeError: an assignment or the file does not have that form, or the file cannot be read.
    """
    values, parameters = _from_file(Path(file)) if file else ({}, {})
    for text in assignments:
        name, equals, value = text.partition("=")
        skill, dot, number = name.strip().partition(".")
        if not (equals and skill and bool(dot) == bool(number) and value.strip()):
            raise CaretreeError(
                f"--set is {text!r}, but SKILL.NUMBER=VALUE, as present_sleeve.max_load=3.5, or NAME=VALUE for a "
                "parameter of the task is asked for"
            )
        try:
            read = load_yaml(value)
        except yaml.YAMLError:
            raise CaretreeError(f"--set {name}: {value!r} is no number, truth value or list of numbers") from None
        if dot:
            values.setdefault(skill, {})[number] = read
        else:
            parameters[skill] = read
    return Given(Settings(values), parameters)


def _from_file(path: Path) -> tuple[dict[str, dict[str, Any]], dict[str, Any]]:
    try:
        content = load_yaml(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise CaretreeError(f"tuning file {path} cannot be read: {error.strerror or error}") from error
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 1
        raise CaretreeError(f"{path}:{line}: {error.problem or 'no YAML'}") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise CaretreeError(f"{path}:1: no YAML text") from error
    if not isinstance(content, dict) or any(isinstance(value, list) for value in content.values()):
        raise CaretreeError(
            f"{path}:1: a tuning file maps skills to numbers to values, `present_sleeve: {{max_load: 3.5}}`, and "
            "parameters of the task to values"
        )
    skills = {str(skill): found for skill, found in content.items() if isinstance(found, dict)}
    values = {skill: {str(number): value for number, value in found.items()} for skill, found in skills.items()}
    return values, {str(name): value for name, value in content.items() if not isinstance(value, dict)}
