"""Robots by name, imported only when they are asked for; a model of one's own is named `package.module:NAME`."""

from __future__ import annotations

import importlib

from .errors import CaretreeError
from .mechanics.robot_model import RobotError, RobotModel

DEFAULT = "baxter"
ROBOTS = {"baxter": "caretree.sim.robot.baxter:BAXTER", "ur5-pair": "caretree.sim.robot.ur5_pair:UR5_PAIR"}


def robot_named(name: str = DEFAULT) -> RobotModel:
    """The model of a robot.

    Args:
        name: one of `ROBOTS`, or `package.module:NAME` of a `RobotModel`.

    Raises:
        RobotError: there is none of that name, or it is no robot that the skills can move.
    """
    module, colon, attribute = ROBOTS.get(name, name).partition(":")
    if not (module and colon and attribute):
        raise RobotError(f"unknown robot {name!r}; there are {', '.join(ROBOTS)}, or give package.module:NAME")
    try:
        found = getattr(importlib.import_module(module), attribute, None)
    except CaretreeError:
        raise  # a sentence of its own
    except Exception as error:  # of somebody else's code
        raise RobotError(f"robot {name} cannot be loaded: {type(error).__name__}: {error}") from error
    if not isinstance(found, RobotModel):
        raise RobotError(f"{module} has no RobotModel {attribute}")
    return found
