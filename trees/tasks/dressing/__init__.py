"""Dress a person who cannot move their arms in a back-opening hospital gown, from the rail to the bed.

| stage | what it does | file |
|---|---|---|
| take_down | takes both ends of the neckline, outside to the front, and lifts the gown off its hook | take_down.py |
| lay | stretches the neckline and lays the gown on the person, arms bare | lay.py |
| dress | one arm after the other: lifts it, draws the sleeve up; then the front flat | dress.py, arm.py |
| spread | draws the gown to the middle, sleeves that have slipped down up, and lays the collar straight | spread.py |

What is owed whenever a stage fails is in safe.py, every number in tuning.py, what it is rehearsed on in rehearsal.py.
"""

from __future__ import annotations

from collections.abc import Sequence

from py_trees.behaviour import Behaviour

from ....perception.classical import ClassicalSenses
from ....perception.senses import Senses
from ....skills.core.context import Context
from ....skills.core.reasons import Reason
from ...nodes.composers import sequence
from ...nodes.decorators import FailSafe, RecoverBy
from ...run.stages import TaskStage
from .arm import sleeve_was_found
from .check_collar import CheckCollar as CheckCollar  # a tree in XML finds the task's own leaves here
from .check_face import CheckFace as CheckFace
from .check_over_hand import CheckOverHand as CheckOverHand
from .check_worn import CheckWorn as CheckWorn
from .draw_flat import DrawFlat as DrawFlat
from .draw_over import DrawOver as DrawOver
from .dress import dress, dressed_anew, laid_by_others, right_sleeve_stands
from .lay import holds_gown, is_down, lay
from .let_gown_go import LetGownGo as LetGownGo
from .look_at_collar import LookAtCollar as LookAtCollar
from .look_at_sleeves import LookAtSleeves as LookAtSleeves
from .rehearsal import scripted as scripted
from .safe import make_safe
from .spread import chest_covered, none_seen_beside, none_seen_low, outside_out, sleeves_known, spread
from .take_down import before_rail, both_ends, fingers_closed, hands_open, holds_gown_with, take_down
from .take_up import GoToStrap as GoToStrap
from .take_up import TakeUpGown as TakeUpGown
from .tuning import DRESSING

STAGES = {
    "take_down": TaskStage(take_down, begins="gown_on_hook"),
    "lay": TaskStage(lay, begins="gown_in_hands"),
    "dress": TaskStage(dress, begins="gown_on_person"),
    "spread": TaskStage(spread, begins="gown_worn"),
}

CONDITIONS = (
    before_rail,
    both_ends,
    chest_covered,
    fingers_closed,
    hands_open,
    holds_gown,
    holds_gown_with,
    is_down,
    laid_by_others,
    outside_out,
    none_seen_beside,
    none_seen_low,
    right_sleeve_stands,
    sleeve_was_found,
    sleeves_known,
)


def senses(context: Context) -> Senses:
    """What sees, unless the run was given others."""
    return ClassicalSenses(context.world.room, context.rng)


def build(context: Context, stages: Sequence[str] = tuple(STAGES)) -> Behaviour:
    """All stages, or only those of the given names.

    Where a sleeve turns out not to be on its arm, as the gown is put straight, that arm is dressed again.
    """
    built = {stage: STAGES[stage].build(context) for stage in stages}
    parts = [until_worn(context, part) if stage == "spread" else part for stage, part in built.items()]
    body = sequence("dressing", *parts)
    return FailSafe("dress safely", body, make_safe(context))


def until_worn(context: Context, last: Behaviour) -> RecoverBy:
    """The stage that puts the gown straight, once more where an arm that was not in its sleeve has been dressed."""

    def anew() -> Behaviour:
        return dressed_anew(context)

    missed = (Reason.SLEEVE_MISSED, Reason.SLEEVE_BESIDE, Reason.NOTHING_SEEN)
    return RecoverBy("until it is worn", last, dict.fromkeys(missed, anew), attempts=DRESSING.dressed_attempts)
