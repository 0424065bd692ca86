"""Stage B: turn the gown that hangs from one hand, and look at it from six orientations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ..sim.world import Frame, Side
from .context import Context
from .hands import hand_now, look_towards
from .ports import Input, Output
from .present import present
from .reasons import Reason
from .skill import Skill

# Turns of the hand [degrees], 30 apart as in the paper.  The second round is for what the first did not show.
ROUNDS = ((-75, -45, -15, 15, 45, 75), (145, 115, 90, -90, -115, -145))


SAME_PLACE = 0.05  # [m]


@dataclass
class Attempts:
    """What was done with the gown since a hand last took it.

    Attributes:
        rounds: of looking at it from all sides.
        places: (3,) in the frame of the holding hand that were grasped at in vain [m].
    """

    rounds: int = 0
    places: list[np.ndarray] = field(default_factory=list)

    def given_up(self) -> tuple[np.ndarray, ...]:
        """Places that were tried twice."""
        return tuple(a for n, a in enumerate(self.places)
                     if any(np.linalg.norm(a - b) < SAME_PLACE for b in self.places[:n]))

    def forget(self) -> None:
        """Start anew, because the gown hangs differently."""
        self.rounds = 0
        self.places.clear()


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
    """Holds the gown up in front of the head camera and looks at it six times while it turns.

    Inputs: `side`, the hand that holds the gown; `settle`, how long the cloth may swing out before each look [s].
    Output: `views`.  When it looks again at a gown held as before, it shows the other side first.
    """

    side = Input(Side)
    settle = Input(float, default=0.4)
    views = Output(Views)
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.SENSOR_LOST,
               Reason.SENSOR_STALE)

    def steps(self) -> Iterator[None]:
        """Bring the hand up, then turn, wait and look in turn."""
        attempts = self.context.memory.of(Attempts, Attempts, name=self.side)
        turns = np.deg2rad(ROUNDS[attempts.rounds % len(ROUNDS)])
        attempts.rounds += 1
        frames, poses = [], []
        for k, turn in enumerate(turns):
            self.note(f"looks at the gown, view {k + 1} of {len(turns)}")
            yield from present(self, self.side, float(turn))
            if k == 0:
                yield from look_towards(self, hand_now(self, self.side)[:3, 3])
            yield from self.wait(self.settle)
            frames.append(self.world.look("head"))
            poses.append(hand_now(self, self.side))
        self.views = Views(side=self.side, frames=tuple(frames), poses_hand_in_map=tuple(poses))

    @classmethod
    def example(cls, context: Context) -> Skill:
        """For the law tests."""
        return cls("view around", context, side="right")
