"""Hold one of the person's arms up, for washing or for looking at a wound, and lay it down again.

    caretree run wash_arm --seed 100 --set arm=left --set seconds=20

| stage | what it does |
|---|---|
| raise | goes beside the arm, looks, takes the upper arm and swings it up, square to it |
| hold | holds it there |
| lower | swings it down, lets it go, sees that it lies |
"""

from __future__ import annotations

from typing import Annotated

from py_trees.behaviour import Behaviour

from ....perception.classical import ClassicalSenses
from ....perception.senses import Senses
from ....sim.world import Side, World
from ....skills.core.context import Context
from ....skills.core.reasons import Reason
from ....skills.core.scope import Scope
from ....skills.geometry.stances import LIFTING, stance
from ....skills.hold_still import HoldStill
from ....skills.lift_arm import LiftArm
from ....skills.look_at_person import LookAtPerson
from ....skills.lower_arm import LowerArm
from ....skills.navigate import Navigate
from ....skills.release_arm import ReleaseArm
from ....skills.retreat import Retreat
from ....skills.scripted.rehearsal import rehearsal
from ....skills.scripted.scripted_senses import ScriptedSenses
from ...nodes.composers import fallback, sequence
from ...nodes.decorators import FailSafe, RecoverBy, Stage, Timeout
from ...run.parameters import Parameter
from .room import judge, scene

AGAIN = (Reason.GRASP_MISSED, Reason.ARM_LOST, Reason.ARM_SLIPPED, Reason.NOTHING_SEEN, Reason.PERSON_MOVED)

__all__ = ["build", "judge", "scene", "scripted", "senses"]


def senses(context: Context) -> Senses:
    """What sees, unless the run was given others."""
    return ClassicalSenses(context.world.room, context.rng)


def build(
    context: Context,
    arm: Annotated[Side, Parameter("whose arm, the person's own left or right")] = "right",
    seconds: Annotated[float, Parameter("how long it is held up", unit="s", low=5.0, high=120.0)] = 10.0,
) -> Behaviour:
    """Up, hold, down; a miss is tried again from a fresh look, and a held arm is never dropped."""
    scope = Scope(context, f"{arm} arm", side=arm, hand=LIFTING[arm])

    def look_again() -> Behaviour:
        return sequence("begin again", let_down(scope, "before trying again"), LookAtPerson("look again", scope))

    up = RecoverBy("lift it", LiftArm("lift", scope), dict.fromkeys(AGAIN, look_again), attempts=3)
    body = sequence(
        "wash an arm",
        Stage(
            "raise",
            None,
            Timeout(
                "raise in time",
                sequence(
                    "go and lift",
                    Navigate("go there", scope, goal=stance(arm, "lift")),
                    LookAtPerson("look", scope),
                    up,
                ),
                seconds=120.0,
            ),
        ),
        Stage("hold", None, HoldStill("hold it up", scope, seconds=seconds)),
        Stage(
            "lower",
            None,
            Timeout(
                "lower in time",
                sequence(
                    "lay it down",
                    ReleaseArm("lower and let go", scope, lower=True, ready="if possible"),
                    LookAtPerson("look at it", scope),
                    LowerArm("see that it lies", scope),
                ),
                seconds=90.0,
            ),
        ),
    )
    safe = sequence(
        "lay the arm down and back off",
        let_down(scope, "safe"),
        Retreat("back off", scope, base_distance=0.2, ready="never"),
    )
    return FailSafe("wash an arm safely", body, safe)


def let_down(scope: Scope, name: str) -> Behaviour:
    """A hand that holds the arm lowers it; where the arm does not come down, it opens all the same."""
    held = Scope(scope, name)
    return fallback(
        f"{held.prefix}let down", ReleaseArm("lower it", held, lower=True), ReleaseArm("open the hand", held)
    )


def scripted(seed: int) -> tuple[World, ScriptedSenses]:
    """The world on which the task is rehearsed: every grasp succeeds, and what is seen is made up."""
    return rehearsal(seed)
