"""The stage `take_down` of the dressing tree: take both ends of the neckline, outside to the front, and lift it off."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from py_trees.behaviour import Behaviour

from ....sim.world import SIDES, Side
from ....skills.control.withdraw import WithdrawTuning
from ....skills.core.context import Context
from ....skills.core.ports import Key
from ....skills.core.reasons import Reason
from ....skills.core.scope import Scope
from ....skills.find_corner import FindCorner
from ....skills.flip_side_check import FlipSideCheck
from ....skills.navigate import Navigate
from ....skills.pre_grasp_manipulate import PreGraspManipulate
from ....skills.raise_corner import RaiseCorner
from ....skills.retreat import Retreat, RetreatTuning
from ....skills.segment_and_grasp import SegmentAndGrasp
from ....skills.take_corner import TakeCorner
from ....skills.take_down import TakeDown
from ....skills.unhook import Unhook
from ....skills.view_around import ViewAround
from ...nodes.composers import fallback, sequence
from ...nodes.condition import Condition
from ...nodes.decorators import RecoverBy, Retry, Stage, timed_stage
from .patience import patient, sight_again, unhurried
from .tuning import DRESSING

TOUCHED = (Reason.MULTI_LAYER, Reason.GRASP_MISSED, Reason.UNREACHABLE, Reason.MOTION_BLOCKED)
LEVEL = RetreatTuning(withdraw=WithdrawTuning(min_rise=-1.0))  # back the way the hand points: nobody lies below it


def take_down(context: Context) -> Stage:
    """The stage `take_down`."""
    rail = Scope(context, "rail", keys=("hook", "corner", "sleeve", "other_sleeve", "hand", "other_hand"))
    outside = patient(rail, FlipSideCheck("outside to the front", rail, hung=True, min_confidence=0.0))
    free = fallback("free hands", Condition("nothing is held", hands_open), Retreat("let go of both ends", rail))
    off = TakeDown("lift it off the hook", rail)
    by_both_ends = RecoverBy(
        "from the side of its outside",
        sequence("by both ends of the neckline", free, take_ends(rail), off),
        {Reason.WRONG_SIDE: lambda: other_side(rail)},
    )
    return timed_stage(
        "take down",
        unhurried(rail, Navigate("go there", rail, goal="rail")),
        fallback("find the outside", outside, unhurried(rail, Navigate("go behind it", rail, goal="rail_back"))),
        fallback(
            "take it",
            Retry("the other end first", patient(rail, by_both_ends), attempts=DRESSING.rail_attempts),
            from_one_hand(context),
        ),
        seconds=DRESSING.take_down_timeout,
    )


def other_side(rail: Scope) -> Behaviour:
    """Let go, and go to the other side of the rail: what hung wrapped round itself showed its outside on both.

    Stopped by the guard half way round, as a wrist swung past the bed, the robot looked for the gown from there until
    the stage ended (309).
    """
    again = Scope(rail, "other side")

    def go(name: str, goal: str) -> Behaviour:
        return unhurried(again, Navigate(name, again, goal=goal))

    behind = sequence("behind the rail", Condition("before the rail", before_rail), go("go behind it", "rail_back"))
    there = fallback("to the other side", behind, go("go before it", "rail"))
    return sequence("the other side of the rail", Retreat("let go of it", again), there)


def square_to_it(scope: Scope) -> Behaviour:
    """Stand before the rail, or behind it, whichever is nearer: who was stopped on the way between sees no gown."""
    before = Condition(f"{scope.prefix}on its front", before_rail)
    front = sequence(f"{scope.prefix}at its front", before, Navigate("stand before it", scope, goal="rail"))
    return fallback(f"{scope.prefix}square to it", front, Navigate("stand behind it", scope, goal="rail_back"))


def take_ends(rail: Scope) -> Behaviour:
    """Both ends of the hung gown's neckline: the one that shows, drawn aside, and then the other one."""
    aside = Scope(rail, keys=("held_length",))
    lengths = rail.key("length"), rail.key("other_length")

    def take_other(name: str, **ports: Any) -> TakeCorner:
        other = {"hand": rail["other_hand"], "sleeve": rail["other_sleeve"], "corner": None, "length": lengths[1]}
        return TakeCorner(name, aside, **other, **ports)

    return sequence(
        "take both ends",
        FindCorner("look for a corner", rail),
        TakeCorner(
            "take a corner", rail, length=lengths[0], opening=DRESSING.corner_opening, depth=DRESSING.corner_depth
        ),
        RaiseCorner("draw it aside", aside),
        FlipSideCheck("outside still to the front", rail, min_confidence=DRESSING.inside_confidence),
        fallback(
            "the other corner",
            take_other(
                "take the other corner", min_confidence=DRESSING.seen_confidence, opening=DRESSING.other_opening
            ),
            take_other(
                "take it from beside",
                beside=True,
                min_confidence=DRESSING.beside_confidence,
                opening=DRESSING.other_opening,
            ),
            sequence(
                "from farther round",
                # weighed once, it may have stopped below the hook, where the hook carries less of the rest by now (173)
                RaiseCorner("draw it farther round", aside, angle=DRESSING.farther_round, max_load=float("inf")),
                take_other("take it from farther round"),
            ),
        ),
        Condition(
            "both ends of the neckline", both_ends, Reason.GRASP_MISSED, length=lengths[0], other_length=lengths[1]
        ),
    )


def from_one_hand(context: Context) -> Behaviour:
    """Where the ends do not show on the hook: off it with one hand, turned before the camera, corner by corner."""
    first = Scope(context, "one hand")
    return sequence(
        "from one hand",
        Retreat("let go of the neckline", first),
        square_to_it(first),
        patient(first, SegmentAndGrasp("take it near the hook", first, hand="right")),
        Unhook("lift it off", first, hand="right"),
        corner_by_corner(context, ("one hand", "again", "anew", "once more"), "right"),
    )


def corner_by_corner(context: Context, names: Sequence[str], hand: Side) -> Behaviour:
    """Both corners of a gown that hangs from one `hand`, as often as there are names.

    What was taken for the first corner may have been none, or both in one hand: then no other one shows, however often
    the gown is looked at (175, 190), but from the place that holds it by now it hangs otherwise.
    """
    tries: list[Behaviour] = []
    other: Side = SIDES[1 - SIDES.index(hand)]
    for n, name in enumerate(names):
        holder = other if n % 2 else hand
        has = Condition(f"{name}, the {holder} hand has it", holds_gown_with, Reason.CLOTH_SLIPPED, hand=holder)
        tries.append(sequence(f"{name}, both corners", has, corners_from(context, name, holder)))
    return fallback(f"{names[0]}, corner by corner", *tries)


def corners_from(context: Context, name: str, hand: Side) -> Behaviour:
    """Both corners of a gown that hangs from one `hand`: the other hand takes one, and then this one the other."""
    first, second = (Scope(context, each, keys=("views", "holder", "former")) for each in (name, f"{name} other"))
    return sequence(
        f"{name}, from the {hand} hand",
        look_and_take(first, hand, DRESSING.first_corner),
        Retreat("let the first place go", first, hands=first["former"], ready="never", tuning=LEVEL),
        look_and_take(second, first["holder"], DRESSING.second_corner),
    )


def both_ends(_: Context, length: float, other_length: float) -> bool:
    """Both strips together [m] are as long as a neckline."""
    shortest, longest = DRESSING.neckline
    return shortest < length + other_length < longest


def look_and_take(scope: Scope, hand: Side | Key, away: tuple[float, float]) -> Behaviour:
    """A corner `away` [m] from the `hand` that the gown hangs from; after a miss it hangs otherwise, without that one.

    Where no corner shows clear of other cloth, looking once more shows the same: then the best one there is is taken,
    nearer or farther off, as a gown may hang bunched up (121); the tug tells whether it was cloth, and the neckline's
    width, once it is stretched, whether it was a corner.  What was touched hangs otherwise, and is looked at anew.
    """

    def once(name: str, take: str, away: tuple[float, float], **more: float) -> Behaviour:
        look = ViewAround(f"look all round{name}", scope, hand=hand)
        take_it = PreGraspManipulate(take, scope, min_distance=away[0], max_distance=away[1], **more)
        return patient(scope, sequence(f"{scope.prefix}once{name}", look, take_it))

    clear = RecoverBy(
        f"{scope.prefix}until it holds a corner",
        once("", "take a corner", away),
        dict.fromkeys(TOUCHED, sight_again(scope, "how it hangs")),
        attempts=DRESSING.corner_attempts,
    )
    any_corner = once(" more", "take the best there is", DRESSING.any_corner, min_confidence=0.0)
    return fallback(f"{scope.prefix}a corner", clear, any_corner)


def before_rail(context: Context) -> bool:
    """The robot stands nearer to the front of the rail than to its back, where a room has both."""
    here, waypoints = context.world.observe().pose_base_in_map[:2], context.world.room.waypoints
    places = {name: waypoints[name][:2] for name in ("rail", "rail_back") if name in waypoints}
    return min(places, key=lambda name: float(np.linalg.norm(here - places[name])), default="rail") == "rail"


def fingers_closed(context: Context, hand: Side) -> bool:
    """The fingers of that hand are closed [m]."""
    return bool(context.world.observe().gripper_opening[SIDES.index(hand)] < DRESSING.empty_opening)


def holds_gown_with(context: Context, hand: Side) -> bool:
    """The fingers of that hand are closed, and it carries some of the gown [N]."""
    carried = -context.world.observe().wrench_hand_in_map[SIDES.index(hand), 2]
    return fingers_closed(context, hand) and bool(carried > DRESSING.end_weight)


def hands_open(context: Context) -> bool:
    """Both grippers stand open [m]."""
    return bool(np.all(context.world.observe().gripper_opening > DRESSING.empty_opening))
