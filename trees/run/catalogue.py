"""The skills that come with the package."""

from __future__ import annotations

import importlib
import pkgutil

from ... import skills
from ...skills.core.settings import setting_name
from ...skills.core.skill import Skill


def all_skills() -> dict[str, type[Skill]]:
    """The leaves of the package by their names: `present_sleeve` -> `PresentSleeve`."""
    for info in pkgutil.iter_modules(skills.__path__):
        if not info.ispkg:
            importlib.import_module(f"{skills.__name__}.{info.name}")
    home = f"{skills.__name__}."
    found = {setting_name(kind): kind for kind in Skill.registry if kind.__module__.startswith(home)}
    return dict(sorted(found.items()))
