"""Stage B: turn the gown that hangs from one hand, and look at it from six orientations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ..sim.world import SIDES, Frame, Side
from .control.hands import hand_now, look_towards
from .control.hold_up import plan_turn, present, turned_by
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill

STEP = np.deg2rad(30.0)  # between two views, from the paper
PACE = 0.4  # share of the joints' speed: the cloth follows the hand and is not flung out
SAME_PLACE = 0.05  # [m]


@dataclass
class Attempts:
    """What was done with the gown since a hand last took it.

    Attributes:
        places: (3,) in the frame of the holding hand that were grasped at in vain [m].
    """

    places: list[np.ndarray] = field(default_factory=list)

    def given_up(self) -> tuple[np.ndarray, ...]:
        """Places that were tried twice."""
        return tuple(
            a for n, a in enumerate(self.places) if any(np.linalg.norm(a - b) < SAME_PLACE for b in self.places[:n])
        )

    def forget(self) -> None:
        """Start anew, because the gown hangs differently."""
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
    """Holds the gown up in front of the head camera and looks at it after every 30 degrees of a turn.

    Inputs: `side`, the hand that holds the gown; `count` of the views; `settle`, how long the cloth may swing out
    before the first [s].  Output: `views`.
    """

    side = Input(Side)
    count = Input(int, default=11)
    settle = Input(float, default=0.5)
    views = Output(Views)
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.SENSOR_LOST, Reason.SENSOR_STALE)

    def steps(self) -> Iterator[None]:
        """Bring the hand up, then turn it to the other end and look on the way."""
        n = SIDES.index(self.side)
        here = turned_by(self.side, self.world.observe().arm_positions[n])
        half = (self.count - 1) * STEP / 2
        turns = np.linspace(-half, half, self.count)[:: 1 if here is None or here < 0 else -1]
        self.note("looks at the gown from all sides")
        yield from present(self, self.side, float(turns[0]))
        yield from look_towards(self, hand_now(self, self.side)[:3, 3])
        yield from self.wait(self.settle)
        turn = plan_turn(self, self.side, float(turns[-1]), scale=PACE)
        self.world.send(turn)
        ends = self.now() + 1.5 * turn.times[-1]
        frames, poses = [], []
        while len(frames) < self.count:
            here = turned_by(self.side, self.world.observe().arm_positions[n])
            if here is not None and abs(here - turns[0]) >= abs(turns[len(frames)] - turns[0]) - 0.03:
                frames.append(self.world.look("head"))
                poses.append(hand_now(self, self.side))
            elif self.now() > ends:
                raise SkillFailure(Reason.MOTION_BLOCKED, f"the hand stopped after {len(frames)} views")
            yield
        self.views = Views(side=self.side, frames=tuple(frames), poses_hand_in_map=tuple(poses))
