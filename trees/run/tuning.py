"""Numbers of skills from the command line, `--set SKILL.NUMBER=VALUE`, and from a tuning file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yaml

from ...sim.errors import CaretreeError
from ...sim.yaml_text import load_yaml
from ...skills.core.settings import Settings


def read_settings(assignments: Sequence[str], file: str | None = None) -> Settings:
    """The numbers in `file`, with those of `assignments` in their place where both name one.

    Args:
        assignments: `present_sleeve.max_load=3.5`; a value is written as in YAML: `3.5`, `true`, `[0.1, 0.2]`.
        file: YAML: skill -> number -> value.

    Raises:
        CaretreeError: an assignment or the file does not have that form, or the file cannot be read.
    """
    values = _from_file(Path(file)) if file else {}
    for text in assignments:
        name, equals, value = text.partition("=")
        skill, dot, number = name.strip().partition(".")
        if not (equals and dot and skill and number and value.strip()):
            raise CaretreeError(
                f"--set is {text!r}, but SKILL.NUMBER=VALUE is asked for, as present_sleeve.max_load=3.5"
            )
        try:
            values.setdefault(skill, {})[number] = load_yaml(value)
        except yaml.YAMLError:
            raise CaretreeError(f"--set {name}: {value!r} is no number, truth value or list of numbers") from None
    return Settings(values)


def _from_file(path: Path) -> dict[str, dict[str, Any]]:
    try:
        content = load_yaml(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise CaretreeError(f"tuning file {path} cannot be read: {error.strerror or error}") from error
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 1
        raise CaretreeError(f"{path}:{line}: {error.problem or 'no YAML'}") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise CaretreeError(f"{path}:1: no YAML text") from error
    if not isinstance(content, dict) or not all(isinstance(numbers, dict) for numbers in content.values()):
        raise CaretreeError(
            f"{path}:1: a tuning file maps skills to numbers to values: `present_sleeve: {{max_load: 3.5}}`"
        )
    return {str(skill): {str(number): value for number, value in found.items()} for skill, found in content.items()}
