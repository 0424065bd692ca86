"""A small task that any world can run: wave with one hand, hold still, and give up safely if it cannot."""

from __future__ import annotations

from typing import Annotated

from py_trees.behaviour import Behaviour

from ...sim.world import Side
from ...skills.core.context import Context
from ...skills.core.ports import Key
from ...skills.core.reasons import Reason
from ...skills.hold_still import HoldStill
from ...skills.move_joint import MoveJoint
from ...skills.retreat import Retreat
from ..nodes.composers import sequence
from ..nodes.decorators import FailSafe, RecoverBy, Stage, Timeout
from ..run.parameters import Parameter


def fingers_apart(context: Context) -> bool:
    """No finger is shut altogether."""
    return bool(context.world.observe().gripper_opening.min() > 0.0)


CONDITIONS = (fingers_apart,)


def build(context: Context, side: Annotated[Side, Parameter("hand of the robot that waves")] = "left") -> Behaviour:
    """Wave once with `side`; if a command is lost, wait and try again."""
    where = Key("wave_before")
    joint = context.world.robot.arm_joints[-2]  # of the wrist
    wave = sequence(
        "wave once",
        MoveJoint("hand up", context, side=side, joint=joint, angle=0.6, before=where),
        MoveJoint("hand back", context, side=side, joint=joint, angle=where, relative=False, speed=0.6),
    )
    again = RecoverBy(
        "wave, again if lost", wave, {Reason.COMMAND_LOST: lambda: HoldStill("wait", context)}, attempts=3
    )
    body = sequence(
        "greet",
        Stage(
            "wave",
            fingers_apart,
            Timeout("wave in time", again, seconds=60.0),
        ),
        Stage("hold", None, HoldStill("hold still", context, seconds=2.0)),
    )
    return FailSafe("wave safely", body, Retreat("let go", context, hand_distance=0.0, ready="never"))
