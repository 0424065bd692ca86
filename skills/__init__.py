"""Leaves of the tree, one file each, and what they share.

What authors need comes from here: `from caretree.skills import Skill, Input, Output, Key, Reason`.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .core.context import Context as Context
    from .core.ports import Input as Input
    from .core.ports import Key as Key
    from .core.ports import Output as Output
    from .core.reasons import Reason as Reason
    from .core.reasons import SkillFailure as SkillFailure
    from .core.scope import Scope as Scope
    from .core.skill import Skill as Skill

_HOME = {
    "Context": ".core.context",
    "Input": ".core.ports",
    "Key": ".core.ports",
    "Output": ".core.ports",
    "Reason": ".core.reasons",
    "Scope": ".core.scope",
    "Skill": ".core.skill",
    "SkillFailure": ".core.reasons",
}
__all__ = sorted(_HOME)  # pyright: ignore[reportUnsupportedDunderAll] filled on first use


def __getattr__(name: str) -> Any:
    """Import what is asked for only then, so that `caretree --help` stays instant."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_HOME[name], __name__), name)
