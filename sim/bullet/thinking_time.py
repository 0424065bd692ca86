"""What thinking costs of the world's time: images are worked through and motions planned while the world goes on."""

from __future__ import annotations

from ..robot.model import HEAD_JOINT
from ..scene import difficulties
from ..scene.difficulties import SIZES, stream
from ..world import Command, JointTrajectory
from ..world_kind import WorldKind


class ThinkingTime:
    """Counts what the robot has thought about and not yet spent time on; nothing where a world does not ask for it.

    Drawn rather than taken from the wall clock, so that the same seed gives the same run on any machine.

    Args:
        seed: of the run.
        kind: of the world.
        sizes: what a thought costs.
        head_joint: that moves at once.
    """

    def __init__(
        self,
        seed: int,
        kind: WorldKind,
        sizes: difficulties.ThinkingTime = SIZES.thinking_time,
        head_joint: str = HEAD_JOINT,
    ) -> None:
        self._head_joint = head_joint
        self._rng = stream(seed, "thinking_time") if kind.has("thinking_time") else None
        self._sizes, self._owed = sizes, 0.0

    def saw(self) -> None:
        """An image has been taken and will be worked through."""
        if self._rng:
            self._owed += self._rng.uniform(*self._sizes.image)

    def decided(self, command: Command) -> None:
        """A command has been thought of: a motion of arms has been planned, all else is a matter of the moment."""
        if self._rng and isinstance(command, JointTrajectory) and command.joints != (self._head_joint,):
            self._owed += self._rng.uniform(*self._sizes.plan)

    def spend(self) -> float:
        """What all of it has taken since the last time [s]."""
        owed, self._owed = self._owed, 0.0
        return owed
