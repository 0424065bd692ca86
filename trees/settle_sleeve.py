"""Part of stage D: see to a sleeve that the other one, drawn up after it, has pulled down."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ..sim.world import Side
from ..skills.bedside import stance
from ..skills.check_sleeve import CheckSleeve
from ..skills.context import Context
from ..skills.look_at_person import LookAtPerson
from ..skills.navigate import Navigate
from ..skills.ports import Key
from .composers import fallback, sequence
from .decorators import RecoverBy
from .dress_arm import MISSES, back_off, grasp_worn, up_arm

# How far down the upper arm the cuff shows at most.  In 31 recorded runs the armhole was 0.77 up the upper arm or more
# where the cuff was at 0.60 or less, 0.67 to 0.77 where it was at 0.61 to 0.76, and 0.50 where it was at 0.85 and 1.03.
SITS, WILL_DO = 0.63, 0.78
TAUT = 3.7  # how hard it is drawn: harder, it would pull the other sleeve down in its turn [N]


def settle_sleeve(context: Context, arm: Side) -> Behaviour:
    """Go to an arm and look how far up its sleeve is; where it is low, take it by the strap and draw it up again."""

    def go(name: str) -> list[Behaviour]:
        return [Navigate(f"{name} to the {arm} sleeve", context, goal=stance(arm, "shoulder")),
                LookAtPerson(f"{name} and look at the {arm} sleeve", context, side=arm, posture=Key(f"{arm}_posture"))]

    def come_back() -> Behaviour:
        return sequence(f"come back to the {arm} sleeve", back_off(context, f"let the low {arm} strap go", 0.25),
                        *go("back up"))

    draw_up = sequence(f"draw the {arm} sleeve up again",
                       grasp_worn(context, arm, f"grasp the low {arm} sleeve"), up_arm(context, arm, "again ", TAUT))
    return sequence(
        f"settle the {arm} sleeve",
        Navigate(f"go round to the {arm} side", context, goal=f"bed_{arm}"), *go("go up"),
        fallback(f"until the {arm} sleeve sits",
                 CheckSleeve(f"the {arm} sleeve sits", context, side=arm, upto=SITS),
                 sequence(f"draw it up and leave the {arm} sleeve",
                          RecoverBy(f"draw at the {arm} sleeve", draw_up, dict.fromkeys(MISSES, come_back)),
                          back_off(context, f"leave the {arm} sleeve", 0.25)),
                 back_off(context, f"leave the {arm} sleeve as it is", 0.25)),
        CheckSleeve(f"the {arm} sleeve will do", context, side=arm, upto=WILL_DO))
