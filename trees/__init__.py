"""What to do, and what if it fails: trees, the runner and the command line.

What authors need comes from here: `from caretree.trees import sequence, fallback, Stage, RecoverBy, FailSafe`.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .nodes.composers import fallback as fallback
    from .nodes.composers import parallel as parallel
    from .nodes.composers import reactive_fallback as reactive_fallback
    from .nodes.composers import sequence as sequence
    from .nodes.condition import Condition as Condition
    from .nodes.decorators import FailSafe as FailSafe
    from .nodes.decorators import RecoverBy as RecoverBy
    from .nodes.decorators import Retry as Retry
    from .nodes.decorators import Stage as Stage
    from .nodes.decorators import Timeout as Timeout
    from .nodes.decorators import timed_stage as timed_stage
    from .run.parameters import Parameter as Parameter
    from .run.stages import TaskStage as TaskStage

_HOME = {
    "Condition": ".nodes.condition",
    "FailSafe": ".nodes.decorators",
    "Parameter": ".run.parameters",
    "RecoverBy": ".nodes.decorators",
    "Retry": ".nodes.decorators",
    "Stage": ".nodes.decorators",
    "TaskStage": ".run.stages",
    "Timeout": ".nodes.decorators",
    "fallback": ".nodes.composers",
    "parallel": ".nodes.composers",
    "sequence": ".nodes.composers",
    "timed_stage": ".nodes.decorators",
    "reactive_fallback": ".nodes.composers",
}
__all__ = sorted(_HOME)  # pyright: ignore[reportUnsupportedDunderAll] filled on first use


def __getattr__(name: str) -> Any:
    """Import what is asked for only then, so that `caretree --help` stays instant."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_HOME[name], __name__), name)
