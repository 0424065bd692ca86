"""Turn the gown that hangs from one hand before the head camera and look at it from all sides."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, Frame, Side
from .control.hands import hand_now
from .control.head import look_towards
from .control.hold_up import plan_turn, present, turned_by
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class ViewAroundTuning(Quantities):
    """Numbers of `ViewAround`."""

    step: float = quantity(
        float(np.deg2rad(30.0)),
        "rad",
        "of the turn between two views",
        "paper: Learning garment manipulation policies toward robot-assisted dressing",
    )
    speed_share: float = quantity(
        0.4, "1", "of the joints' greatest speed", "choice: the cloth follows the hand and is not flung out"
    )
    tolerance: float = quantity(0.03, "rad", "of the turn at which a view is taken", "choice: small beside a step")
    max_duration: float = quantity(
        1.5, "1", "of the turn, as a multiple of the planned duration", "choice: room for a guard that slows it down"
    )


@dataclass(frozen=True, kw_only=True)
class Views:
    """What the head camera saw of a gown that hangs from one hand.

    Attributes:
        hand: that holds it.
        frames: oldest first.
        poses_hand_in_map: (4, 4) of that hand at each frame, from the joint angles.
    """

    hand: Side
    frames: tuple[Frame, ...]
    poses_hand_in_map: tuple[np.ndarray, ...]


class ViewAround(Skill):
    """Holds the gown up in front of the head camera and looks at it after every step of a turn.

    It fails where the hand does not reach the last view in time.
    """

    hand = Input(Side, doc="the hand that holds the gown")
    count = Input(int, unit="1", doc="number of views", default=11)
    settle = Input(float, unit="s", doc="how long the cloth swings out before the first view", default=0.5)
    tuning = Input(ViewAroundTuning, default=ViewAroundTuning(), doc="numbers of this skill")
    views = Output(Views, doc="what the head camera saw")
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.SENSOR_LOST, Reason.SENSOR_STALE)

    def steps(self) -> Iterator[None]:
        """Bring the hand up, then turn it to the other end and look on the way."""
        tuning, n = self.tuning, SIDES.index(self.hand)
        here = turned_by(self.world.robot, self.hand, self.world.observe().arm_positions[n])
        half = (self.count - 1) * tuning.step / 2
        turns = np.linspace(-half, half, self.count)[:: 1 if here is None or here < 0 else -1]
        self.note("looks at the gown from all sides")
        yield from present(self, self.hand, float(turns[0]))
        yield from look_towards(self, hand_now(self, self.hand)[:3, 3])
        yield from self.wait(self.settle)
        turn = plan_turn(self, self.hand, float(turns[-1]), scale=tuning.speed_share)
        self.world.send(turn)
        ends = self.now() + tuning.max_duration * turn.times[-1]
        frames, poses = [], []
        while len(frames) < self.count:
            here = turned_by(self.world.robot, self.hand, self.world.observe().arm_positions[n])
            if here is not None and abs(here - turns[0]) >= abs(turns[len(frames)] - turns[0]) - tuning.tolerance:
                frames.append(self.world.look("head"))
                poses.append(hand_now(self, self.hand))
            elif self.now() > ends:
                raise SkillFailure(Reason.MOTION_BLOCKED, f"the hand stopped after {len(frames)} views")
            yield
        self.views = Views(hand=self.hand, frames=tuple(frames), poses_hand_in_map=tuple(poses))
