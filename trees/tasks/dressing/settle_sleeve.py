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

# How far down the arm the cuff shows at most, from the shoulder.  In 65 recorded sleeves the armhole was up the upper
# arm by 1.11 less 1.96 for each metre of that, give or take 0.04: by 0.73 for the one and 0.68 for the other.  A
# sleeve that was drawn up again from 0.74 came to rest at 0.71, from 0.51 and 0.66 at 0.66 and 0.77 [m].
SITS, WILL_DO = 0.195, 0.22
TAUT = 3.7  # how hard it is drawn: harder, it would pull the other sleeve down in its turn [N]


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
            up_arm(context, arm, "again ", TAUT),
        )
        return sequence(
            f"draw the {arm} sleeve up again",
            RecoverBy(f"draw at the {arm} sleeve", once, dict.fromkeys(MISSES, come_back)),
            back_off(context, f"leave the {arm} sleeve", 0.25),
            *go("return"),
        )

    def come_back() -> Behaviour:
        return sequence(
            f"come back to the {arm} sleeve", back_off(context, f"let the low {arm} strap go", 0.25), *go("back up")
        )

    sits = CheckSleeve(f"the {arm} sleeve sits", context, side=arm, upto=SITS)
    return sequence(
        f"settle the {arm} sleeve",
        Navigate(f"go round to the {arm} side", context, goal=f"bed_{arm}"),
        *go("go up"),
        fallback(
            f"as far as the {arm} sleeve goes",
            RecoverBy(f"until the {arm} sleeve sits", sits, {Reason.SLEEVE_LOW: draw_up}, attempts=3),
            back_off(context, f"leave the {arm} sleeve as it is", 0.25),
        ),
        CheckSleeve(f"the {arm} sleeve will do", context, side=arm, upto=WILL_DO),
    )
