"""Stage B: turn the gown that hangs from one hand, and look at it from six orientations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..sim.world import Frame, Side
from .context import Context
from .hands import hand_now, look_towards
from .ports import Input, Output
from .present import present
from .reasons import Reason
from .skill import Skill

STEP = np.deg2rad(30.0)  # from the paper
FIRST = np.deg2rad(-75.0)  # yaw of the hand at the first view, against the base


@dataclass(frozen=True, kw_only=True)
class Views:
    """What the head camera saw of a gown that hangs from one hand.

    Attributes:
        side: the hand that holds it.
        frames: oldest first.
        poses_hand_in_map: (4, 4) of that hand at each frame, from the joint angles.
    """

    side: Side
    frames: tuple[Frame, ...]
    poses_hand_in_map: tuple[np.ndarray, ...]


class ViewAround(Skill):
    """Holds the gown up in front of the head camera and looks after every 30 degrees of a turn.

    Inputs: `side`, the hand that holds the gown; `count`, how many views; `settle`, how long the cloth may swing
    out before each [s].  Output: `views`.
    """

    side = Input(Side)
    count = Input(int, default=6)
    settle = Input(float, default=0.4)
    views = Output(Views)
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.SENSOR_LOST,
               Reason.SENSOR_STALE)

    def steps(self) -> Iterator[None]:
        """Bring the hand up, then turn, wait and look in turn."""
        frames, poses = [], []
        for k in range(self.count):
            self.note(f"looks at the gown, view {k + 1} of {self.count}")
            yield from present(self, self.side, FIRST + k * STEP)
            if k == 0:
                yield from look_towards(self, hand_now(self, self.side)[:3, 3])
            yield from self.wait(self.settle)
            frames.append(self.world.look("head"))
            poses.append(hand_now(self, self.side))
        self.views = Views(side=self.side, frames=tuple(frames), poses_hand_in_map=tuple(poses))

    @classmethod
    def example(cls, context: Context) -> Skill:
        """For the law tests."""
        return cls("view around", context, side="right", count=2)
