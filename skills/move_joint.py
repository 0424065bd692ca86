"""Turn one joint of an arm, by an angle or to one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, JointTrajectory, Side
from .control.follow import follow
from .core.context import Context
from .core.ports import Input, Output, PortError
from .core.reasons import Reason
from .core.scope import Scope
from .core.skill import Skill

WHOLE_TURN = 2.0 * np.pi  # [rad]


@dataclass(frozen=True, kw_only=True)
class MoveJointTuning(Quantities):
    """Numbers of `MoveJoint`."""

    min_duration: float = quantity(0.1, "s", "of any motion", "choice: a trajectory that goes nowhere takes time too")


class MoveJoint(Skill):
    """Turns one joint at a given speed and says where it was before; nothing else of the arm moves.

    It fails where the command is lost or the joint does not arrive.
    """

    side = Input(Side, doc="the arm")
    joint = Input(str, doc="name of the joint, without the side; one of the robot's `arm_joints`")
    angle = Input(float, unit="rad", doc="by which the joint turns, or where it goes")
    relative = Input(bool, doc="whether `angle` counts from where the joint is", default=True)
    speed = Input(float, unit="rad/s", doc="of the joint", default=0.3)
    before = Output(float, unit="rad", doc="where the joint was")
    tuning = Input(MoveJointTuning, default=MoveJointTuning(), doc="numbers of this skill")
    reasons = (Reason.COMMAND_LOST, Reason.MOTION_BLOCKED)

    def __init__(self, name: str, context: Context | Scope, **ports: Any) -> None:
        """Refuse a joint that the robot does not have, and degrees, before anything moves.

        Raises:
            PortError: it does not have it, `angle` is more than a whole turn, or `speed` not above 0.
        """
        super().__init__(name, context, **ports)
        if isinstance(joint := ports.get("joint"), str):
            self._place_of(joint)
        if isinstance(angle := ports.get("angle"), int | float) and not abs(angle) <= WHOLE_TURN:
            raise PortError(
                f"MoveJoint.angle is {angle:g} rad, but no joint turns farther than 2 pi: is it in degrees?"
            )

        if isinstance(speed := self.bindings["speed"], int | float) and not speed > 0.0:
            raise PortError(f"MoveJoint.speed is {speed:g} rad/s, but must be above 0: `angle` says which way")

    def steps(self) -> Iterator[None]:
        """Send one trajectory and see it through."""
        here = float(self.world.observe().arm_positions[SIDES.index(self.side), self._place_of(self.joint)])
        goal = here + self.angle if self.relative else self.angle
        self.note(f"turns {self.joint} by {goal - here:.2f} rad")
        duration = max(abs(goal - here) / self.speed, self.tuning.min_duration)
        joints, times = (f"{self.side}_{self.joint}",), np.array((0.0, duration))
        yield from follow(self, JointTrajectory(joints=joints, times=times, positions=np.array(((here,), (goal,)))))
        self.before = here

    def _place_of(self, joint: str) -> int:
        """Where a joint stands among those of an arm."""
        robot = self.context.world.robot
        if joint not in robot.arm_joints:
            known = ", ".join(robot.arm_joints)
            raise PortError(f"MoveJoint.joint is {joint!r}, but the robot {robot.name} has {known}")
        return robot.arm_joints.index(joint)
