"""Part of the stage `spread`: see to a sleeve that the other one, drawn up after it, has pulled down."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ....sim.world import Side
from ....skills.check_sleeve import CheckSleeve
from ....skills.core.context import Context
from ....skills.core.ports import Key
from ....skills.core.reasons import Reason
from ....skills.geometry.stances import stance
from ....skills.look_at_person import LookAtPerson
from ....skills.navigate import Navigate
from ...nodes.composers import fallback, sequence
from ...nodes.decorators import RecoverBy
from .dress_arm import MISSES, back_off, grasp_worn, up_arm
from .tuning import DRESSING


def settle_sleeve(context: Context, arm: Side) -> Behaviour:
    """Go to an arm and look how far up its sleeve is; while it is low, take it by the strap and draw it up again."""

    def go(name: str) -> list[Behaviour]:
        return [
            Navigate(f"{name} to the {arm} sleeve", context, goal=stance(arm, "shoulder")),
            LookAtPerson(f"{name} and look at the {arm} sleeve", context, side=arm, posture=Key(f"{arm}_posture")),
        ]

    def draw_up() -> Behaviour:
        once = sequence(
            f"draw the {arm} sleeve up once",
            grasp_worn(context, arm, f"grasp the low {arm} sleeve"),
            up_arm(context, arm, DRESSING.again_load, "again "),
        )
        return sequence(
            f"draw the {arm} sleeve up again",
            RecoverBy(f"draw at the {arm} sleeve", once, dict.fromkeys(MISSES, come_back)),
            back_off(context, f"leave the {arm} sleeve", DRESSING.back_off_distance),
            *go("return"),
        )

    def come_back() -> Behaviour:
        return sequence(
            f"come back to the {arm} sleeve",
            back_off(context, f"let the low {arm} strap go", DRESSING.back_off_distance),
            *go("back up"),
        )

    sits = CheckSleeve(f"the {arm} sleeve sits", context, side=arm, max_cuff_distance=DRESSING.cuff_sits)
    return sequence(
        f"settle the {arm} sleeve",
        Navigate(f"go round to the {arm} side", context, goal=f"bed_{arm}"),
        *go("go up"),
        fallback(
            f"as far as the {arm} sleeve goes",
            RecoverBy(f"until the {arm} sleeve sits", sits, {Reason.SLEEVE_LOW: draw_up}, attempts=3),
            back_off(context, f"leave the {arm} sleeve as it is", DRESSING.back_off_distance),
        ),
        CheckSleeve(f"the {arm} sleeve will do", context, side=arm, max_cuff_distance=DRESSING.cuff_will_do),
    )
