"""A skill's own view of the world: it can look at any time, and command only while it holds the motion lease."""

from __future__ import annotations

from dataclasses import replace

from ...sim.errors import CaretreeError
from ...sim.mechanics.robot_model import RobotModel
from ...sim.world import BaseVelocity, Clock, Command, Frame, HandTwist, JointTrajectory, Observation, RoomMap
from .context import Context
from .lease import Owner


class LeaseError(CaretreeError):
    """A skill commanded without holding the lease."""


def duration_of(command: Command) -> float:
    """How long a command moves arms or base [s]; a gripper alone moves neither."""
    if isinstance(command, JointTrajectory):
        return float(command.times[-1])
    return command.duration if isinstance(command, (HandTwist, BaseVelocity)) else 0.0


class WorldHandle:
    """The world for one owner.

    Attributes:
        moving_until: world clock at which the last motion sent is due to end [s].
    """

    def __init__(self, context: Context, owner: Owner) -> None:
        self._context = context
        self._owner = owner
        self.moving_until = float("-inf")

    @property
    def clock(self) -> Clock:
        """The world's clock."""
        return self._context.world.clock

    @property
    def room(self) -> RoomMap:
        """The mapped room."""
        return self._context.world.room

    @property
    def robot(self) -> RobotModel:
        """What the robot is made of."""
        return self._context.world.robot

    def observe(self) -> Observation:
        """Latest proprioception; raises SensorLost."""
        return self._context.world.observe()

    def look(self, camera: str) -> Frame:
        """Latest frame of a camera; raises SensorLost, also when it is too old."""
        return self._context.world.look(camera)

    def send(self, command: Command, *, retreat: bool = False) -> Command:
        """Start a motion; see World.send.

        Raises:
            LeaseError: the owner does not hold the lease.
            SkillFailure: the guard refuses.
        """
        self._require()
        if isinstance(command, (HandTwist, BaseVelocity)) and command.duration < self._context.hold:
            command = replace(command, duration=self._context.hold)
        sent = self._context.world.send(command, retreat=retreat)
        self.moving_until = max(self.moving_until, self.clock.now() + duration_of(sent))
        return sent

    def stop(self) -> None:
        """End every motion now.

        Raises:
            LeaseError: the owner does not hold the lease.
        """
        self._require()
        self.moving_until = float("-inf")
        self._context.world.stop()

    def _require(self) -> None:
        holder = self._context.lease.holder
        if holder is not self._owner:
            who = f"{holder.name!r} holds it" if holder else "it holds no lease (is `commands` False?)"
            raise LeaseError(f"skill {self._owner.name!r} may not command: {who}")
