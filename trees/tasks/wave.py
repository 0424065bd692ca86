"""A small task that any world can run: wave with one hand, hold still, and give up safely if it cannot."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from py_trees.behaviour import Behaviour

from ...sim.world import ARM_JOINTS, SIDES, GripperOpening, JointTrajectory, Side
from ...skills.control.follow import follow
from ...skills.core.context import Context
from ...skills.core.ports import Input, Key, Output
from ...skills.core.reasons import Reason
from ...skills.core.skill import Skill
from ..nodes.composers import sequence
from ..nodes.decorators import FailSafe, RecoverBy, Stage, Timeout

SHORTEST = 0.1  # a trajectory takes time, one that goes nowhere too [s]


class MoveJoint(Skill):
    """Turns one joint by `angle` [rad] at `speed` [rad/s]; says where it was before."""

    side = Input(Side)
    joint = Input(str)
    angle = Input(float)
    speed = Input(float, default=0.3)
    before = Output(float)
    reasons = (Reason.COMMAND_LOST, Reason.MOTION_BLOCKED)

    def steps(self) -> Iterator[None]:
        """Send one trajectory and see it through."""
        self.note(f"turns {self.joint} by {self.angle:.2f} rad")
        here = float(self.world.observe().arm_positions[SIDES.index(self.side), ARM_JOINTS.index(self.joint)])
        duration = max(abs(self.angle) / self.speed, SHORTEST)
        yield from follow(
            self,
            JointTrajectory(
                joints=(f"{self.side}_{self.joint}",),
                times=np.array((0.0, duration)),
                positions=np.array(((here,), (here + self.angle,))),
            ),
        )
        self.before = here


class ReturnJoint(Skill):
    """Brings one joint back to `angle` [rad]."""

    side = Input(Side)
    joint = Input(str)
    angle = Input(float)
    reasons = (Reason.COMMAND_LOST, Reason.MOTION_BLOCKED)

    def steps(self) -> Iterator[None]:
        """Send one trajectory and see it through."""
        here = float(self.world.observe().arm_positions[SIDES.index(self.side), ARM_JOINTS.index(self.joint)])
        yield from follow(
            self,
            JointTrajectory(
                joints=(f"{self.side}_{self.joint}",),
                times=np.array((0.0, 1.0)),
                positions=np.array(((here,), (self.angle,))),
            ),
        )


class Hold(Skill):
    """Stands still and watches for `seconds`; gives up when the camera does."""

    commands = False
    seconds = Input(float, default=1.0)
    reasons = (Reason.SENSOR_LOST, Reason.SENSOR_STALE)

    def steps(self) -> Iterator[None]:
        """Look once per tick."""
        end = self.now() + self.seconds
        while self.now() < end:
            self.world.look("head")
            yield


class LetGo(Skill):
    """Opens both hands; the safe branch of tasks that hold nothing heavy."""

    reasons = (Reason.TIMEOUT,)

    def steps(self) -> Iterator[None]:
        """Stop, open, and wait until the fingers are open."""
        self.world.stop()
        for side in SIDES:
            self.world.send(GripperOpening(side=side, opening=0.08), retreat=True)
        yield from self.until(lambda: self.world.observe().gripper_opening.min() > 0.07, timeout=3.0)


def build(context: Context, side: Side = "left") -> Behaviour:
    """Wave once with `side`; if a command is lost, wait and try again."""
    where = Key("wave_before")
    wave = sequence(
        "wave once",
        MoveJoint("hand up", context, side=side, joint="w1", angle=0.6, before=where),
        ReturnJoint("hand back", context, side=side, joint="w1", angle=where),
    )
    again = RecoverBy("wave, again if lost", wave, {Reason.COMMAND_LOST: lambda: Hold("wait", context)}, attempts=3)
    body = sequence(
        "greet",
        Stage(
            "wave",
            lambda context: context.world.observe().gripper_opening.min() > 0.0,
            Timeout("wave in time", again, seconds=60.0),
        ),
        Stage("hold", None, Hold("hold still", context, seconds=2.0)),
    )
    return FailSafe("wave safely", body, LetGo("let go", context))
