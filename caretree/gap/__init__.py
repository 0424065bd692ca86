"""What users of the gap workflow import: `from caretree.gap import System, Effect, Parameter, run`."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from caretree.learning.gap.export import write_robot_file as write_robot_file
    from caretree.learning.gap.findings import EffectFinding as EffectFinding
    from caretree.learning.gap.findings import Verdict as Verdict
    from caretree.learning.gap.notebook import Result as Result
    from caretree.learning.gap.notebook import run as run
    from caretree.learning.gap.own.find_system import find_system as find_system
    from caretree.learning.gap.own.system import Effect as Effect
    from caretree.learning.gap.own.system import System as System
    from caretree.learning.gap.own.values import values_of as values_of
    from caretree.sim.effects.effect import Parameter as Parameter

_HOME = {
    "Effect": "learning.gap.own.system",
    "EffectFinding": "learning.gap.findings",
    "Parameter": "sim.effects.effect",
    "Result": "learning.gap.notebook",
    "System": "learning.gap.own.system",
    "Verdict": "learning.gap.findings",
    "find_system": "learning.gap.own.find_system",
    "run": "learning.gap.notebook",
    "values_of": "learning.gap.own.values",
    "write_robot_file": "learning.gap.export",
}
__all__ = sorted(_HOME)  # pyright: ignore[reportUnsupportedDunderAll] filled on first use


def __getattr__(name: str) -> Any:
    """Import what is asked for only then."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"caretree.{_HOME[name]}"), name)
