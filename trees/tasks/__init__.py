"""Tasks by name, one file or folder each: a module with `build(context, **params)` that returns the tree's root."""

from __future__ import annotations

import pkgutil


def task_names() -> list[str]:
    """Names of the tasks that come with the package."""
    return sorted(info.name for info in pkgutil.iter_modules(__path__))
