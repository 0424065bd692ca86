"""The stage `lay` of the dressing tree: unfold the gown and lay it on the person, outside up, arms bare.

Hands that hold both ends of the neckline can be drawn apart by its length.  Where they cannot, one of them holds
something else: the right one lets go and takes an end of the gown that hangs from the left one; where there is none as
far from it as a neckline is long, it is the left one that holds none, and both take an end anew.
"""

from __future__ import annotations

import numpy as np
from py_trees.behaviour import Behaviour

from ....sim.world import SIDES, Side
from ....skills.core.context import Context
from ....skills.core.reasons import Reason
from ....skills.core.scope import Scope
from ....skills.flip_side_check import FlipSideCheck
from ....skills.lay_gown import LayGown
from ....skills.retreat import Retreat
from ....skills.stretch_neckline import StretchNeckline
from ...nodes.composers import fallback, sequence
from ...nodes.condition import Condition
from ...nodes.decorators import Stage, timed_stage
from .let_gown_go import LetGownGo
from .patience import patient
from .take_down import LEVEL, corner_by_corner, holds_gown_with, look_and_take
from .tuning import DRESSING


def lay(context: Context) -> Stage:
    """The stage `lay`."""
    gown = Scope(context, "gown", keys=("width",))
    by_ends = fallback("by both ends", stretch(gown, "stretch the neckline"), *ends_anew(context, gown, ("end", "far")))
    return timed_stage("lay", by_ends, *on_person(gown), precondition=holds_gown, seconds=DRESSING.lay_timeout)


def on_person(gown: Scope) -> list[Behaviour]:
    """Lay a gown whose neckline is stretched between both hands."""
    outside = FlipSideCheck("outside to the robot", gown, min_confidence=DRESSING.laid_inside_confidence)
    laid = fallback(f"{gown.prefix}on the person", LayGown("lay it on the person", gown), where_it_is(gown))
    return [patient(gown, outside), laid]


def stretch(gown: Scope, name: str) -> Behaviour:
    """Stretch the neckline; fails where the hands stay nearer together than its ends."""
    return patient(gown, StretchNeckline(name, gown, min_width=DRESSING.stretched_neckline))


def ends_anew(context: Context, gown: Scope, names: tuple[str, str]) -> list[Behaviour]:
    """Ways to an end that was not held: taken anew with the right hand, else both in turn, from the left hand or right.

    What the left hand holds may be no end either: then all of it is done once more from what the right hand holds.
    Leaves that take corners from a hand are called by the `names`.
    """

    def holds(name: str, hand: Side) -> Condition:
        return Condition(f"{gown.prefix}{name}", holds_gown_with, Reason.CLOTH_SLIPPED, hand=hand)

    end = Scope(context, f"right {names[0]}", keys=("views", "holder", "former"))
    right = sequence(
        f"{gown.prefix}the right hand anew",
        holds("the left hand holds it too", "left"),
        Retreat("let go", end, hands="right", ready="never", tuning=LEVEL),
        look_and_take(end, "left", DRESSING.second_corner),
        stretch(gown, "stretch by the new right end"),
    )

    def both(hand: Side, name: str) -> Behaviour:
        other: Side = SIDES[1 - SIDES.index(hand)]
        return sequence(
            f"{gown.prefix}both anew, from the {hand} one",
            holds(f"the {hand} hand still holds it", hand),
            Retreat("let go", Scope(gown, f"from the {hand} hand"), hands=other, ready="never", tuning=LEVEL),
            corner_by_corner(context, (name, f"{name} again", f"{name} anew"), hand),
            stretch(gown, f"stretch from the {hand} hand"),
        )

    return [right, both("left", names[0]), both("right", names[1])]


def holds_gown(context: Context) -> bool:
    """Both hands together carry what a gown weighs [N]."""
    return bool(-np.sum(context.world.observe().wrench_hand_in_map[:, 2]) > DRESSING.gown_weight)


def where_it_is(gown: Scope) -> Behaviour:
    """A gown that is down is let go of although a hand met a leg on its last centimetres."""
    down = Condition(f"{gown.prefix}it is down already", is_down, Reason.MOTION_BLOCKED)
    return sequence(f"{gown.prefix}let it go where it is", down, LetGownGo("let it go", gown))


def is_down(context: Context) -> bool:
    """Both hands are as low as the person lies: one that met a leg, or a hand, on its way down can let the gown go."""
    heights = context.world.observe().pose_hand_in_map[:, 2, 3] - context.world.room.bed[1, 2]
    return bool(np.all(heights < DRESSING.laid_below))
