"""Which form an observation has: arrays of which shape, single numbers, and fingers that stand apart by metres.

A driver that leaves out a joint, counts in millimetres or gives nothing at all is told so in one sentence, at every
observation of a run (`freshness.py`) and by `check_world`.
"""

from __future__ import annotations

from operator import attrgetter
from typing import Any

import numpy as np

from .mechanics.robot_model import RobotModel
from .world import Observation

ARRAYS: dict[str, tuple[int, ...]] = {  # beside those of the arms' joints
    "pose_base_in_map": (3,),
    "twist_base": (3,),
    "gripper_opening": (2,),
    "gripper_force": (2,),
    "wrench_hand_in_map": (2, 6),
    "pose_hand_in_map": (2, 4, 4),
}
OF_JOINTS = ("arm_positions", "arm_velocities", "arm_efforts")
SINGLE = ("time", "head_pan", "emergency_stop")
NUMBER = (float, int, np.number, np.bool_)
OPENING_SLACK = 0.01  # [m] that fingers may be measured to overlap: where they touch is calibrated roughly
OPENING_MAX = 2.0  # times the stroke that the robot's gripper is known with; millimetres are a thousand times that

_shapes = attrgetter(*(f"{name}.shape" for name in (*OF_JOINTS, *ARRAYS)))
_single = attrgetter(*SINGLE)


class ObservationForm:
    """What every observation of one robot looks like.

    Args:
        robot: whose.
    """

    def __init__(self, robot: RobotModel) -> None:
        self.shapes = dict.fromkeys(OF_JOINTS, (2, robot.dof)) | ARRAYS
        self._shapes = tuple(self.shapes.values())
        self._widest = OPENING_MAX * robot.gripper.stroke
        self._stroke = robot.gripper.stroke

    def fault(self, seen: Observation) -> str:
        """What is wrong with it, one clause; empty where it has that form."""
        try:
            if _shapes(seen) == self._shapes:  # several times in every tick: all of them at once
                time, pan, pressed = _single(seen)
                if isinstance(time, NUMBER) and isinstance(pan, NUMBER) and isinstance(pressed, NUMBER):
                    return self._apart(seen.gripper_opening)
        except (AttributeError, TypeError, ValueError):
            pass  # said below
        return self._named(seen)

    def _apart(self, opening: np.ndarray) -> str:
        left, right = opening.tolist()
        if left > self._widest or right > self._widest or left < -OPENING_SLACK or right < -OPENING_SLACK:
            return f"gripper_opening is {opening.tolist()} m, but 0 to {self._stroke:g} m is asked for"
        return ""

    def _named(self, seen: Any) -> str:
        if not isinstance(seen, Observation):
            return f"observe gave no Observation, but {'None' if seen is None else f'a {type(seen).__name__}'}"
        for name, shape in self.shapes.items():
            value = getattr(seen, name)
            if not isinstance(value, np.ndarray):
                return f"{name} is a {type(value).__name__}, but an array of shape {shape} is asked for"
            if value.shape != shape:
                return f"{name} has shape {value.shape}, but {shape} is asked for"
        for name in SINGLE:
            value = getattr(seen, name)
            if not isinstance(value, NUMBER) and not (isinstance(value, np.ndarray) and value.shape == ()):
                shape = f" of shape {value.shape}" if isinstance(value, np.ndarray) else ""
                asked = "yes or no" if name == "emergency_stop" else "a number"
                return f"{name} is a {type(value).__name__}{shape}, but {asked} is asked for"
        try:
            return self._apart(seen.gripper_opening)
        except TypeError:
            return "gripper_opening holds what is no number"
