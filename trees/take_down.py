"""Stage A of the dressing tree: from the side that shows the outside, take both ends of the neckline, lift it off."""

from __future__ import annotations

import numpy as np
from py_trees.behaviour import Behaviour

from ..sim.world import SIDES, Side
from ..skills.context import Context
from ..skills.flip_side_check import FlipSideCheck
from ..skills.navigate import Navigate
from ..skills.ports import Key
from ..skills.pre_grasp_manipulate import PreGraspManipulate
from ..skills.raise_corner import RaiseCorner
from ..skills.reasons import Reason
from ..skills.release import Release
from ..skills.retreat import Retreat
from ..skills.segment_and_grasp import SegmentAndGrasp
from ..skills.take_corner import TakeCorner
from ..skills.take_down import TakeDown
from ..skills.unhook import Unhook
from ..skills.view_around import ViewAround
from .composers import fallback, sequence
from .decorators import Condition, Retry, Stage, Timeout

HAND_OF: dict[Side, Side] = {"left": "right", "right": "left"}  # the outside faces the robot: corners are mirrored
NECKLINE = 0.80  # both strips of a hung gown's neckline together, within 4 cm [m]
FARTHER_ROUND = float(np.deg2rad(75.0))  # behind the rail, where the fold that hides a corner opens to the robot [rad]


def take_down(context: Context) -> Behaviour:
    """Stage A."""
    find_outside = fallback(
        "find the outside",
        FlipSideCheck("outside to the front", context, hung=True, sure=0.0),
        Navigate("go behind the rail", context, goal="rail_back"))
    by_both_ends = sequence(
        "by both ends of the neckline",
        fallback("take both ends of the neckline", take_ends(context, "left"),
                 sequence("the other one first", Retreat("let go of both ends", context), take_ends(context, "right"))),
        TakeDown("lift it off the hook", context, hook=Key("hook")))
    return Stage("A take down", None, Timeout("A in time", sequence(
        "take the gown down", Navigate("go to the rail", context, goal="rail"), find_outside,
        fallback("take it", by_both_ends, from_one_hand(context))), seconds=260.0))


def from_one_hand(context: Context) -> Behaviour:
    """Where the ends do not show on the hook: off it with one hand, turned before the camera, corner by corner."""
    views, holder, former = Key("views"), Key("holder"), Key("former")
    return sequence(
        "from one hand",
        Retreat("let go of the neckline", context),
        SegmentAndGrasp("take it near the hook", context, side="right"),
        Unhook("lift it off with one hand", context, side="right"),
        ViewAround("look at it from all sides", context, side="right", views=views),
        PreGraspManipulate("take one corner", context, views=views, holder=holder, former=former),
        Release("let the place near the hook go", context, side=former),
        ViewAround("look at it again from all sides", context, side=holder, views=views),
        PreGraspManipulate("take the other corner", context, views=views, nearest=0.3))


def take_ends(context: Context, first: Side) -> Behaviour:
    """Both ends of the hung gown's neckline: `first`, the other one, the first again where that was not it."""
    second: Side = "right" if first == "left" else "left"
    hook, lengths, held = Key("hook"), {side: Key(f"{side}_strip") for side in SIDES}, Key("held")

    def take(corner: Side, name: str, **ports: object) -> TakeCorner:
        return TakeCorner(f"take the {corner} corner {name}", context, hand=HAND_OF[corner], sleeve=corner,
                          length=lengths[corner], **ports)

    def complete(context: Context) -> bool:
        """Both strips together are as long as a neckline."""
        return abs(sum(context.board.get(key.name) for key in lengths.values()) - NECKLINE) < 0.06

    again = sequence(
        f"the {first} corner was not it",
        Retreat(f"let the {first} one go", context, hands=HAND_OF[first]),
        RaiseCorner(f"draw the {second} corner aside for the {first}", context, hand=HAND_OF[second], hook=hook,
                    held=held),
        take(first, "once more", known_hook=hook, held=held))
    return sequence(
        f"take the ends, {first} first",
        Retry(f"the {first} corner, again", take(first, "first", hook=hook, opening=0.04, depth=0.006), attempts=2),
        RaiseCorner(f"draw the {first} corner aside first", context, hand=HAND_OF[first], hook=hook, held=held),
        FlipSideCheck(f"outside still to the front, {first} corner aside", context, sure=0.3),
        fallback(f"the {second} corner",
                 take(second, "second", known_hook=hook, held=held, opening=0.035),
                 take(second, "with wide fingers", known_hook=hook, held=held),
                 sequence(f"the {second} corner from farther round",
                          RaiseCorner(f"turn the gown by the {first} corner", context, hand=HAND_OF[first], hook=hook,
                                      away=FARTHER_ROUND),
                          take(second, "from farther round", known_hook=hook, held=held))),
        fallback(f"is it the neckline, {first} first", Condition(
            f"both ends, {first} first", complete, Reason.GRASP_MISSED), again))
