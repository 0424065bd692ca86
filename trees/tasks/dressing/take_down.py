"""The stage `take_down` of the dressing tree: take both ends of the neckline, outside to the front, and lift it off."""

from __future__ import annotations

import numpy as np
from py_trees.behaviour import Behaviour

from ....skills.core.context import Context
from ....skills.core.ports import Key
from ....skills.core.reasons import Reason
from ....skills.find_corner import FindCorner
from ....skills.flip_side_check import FlipSideCheck
from ....skills.navigate import Navigate
from ....skills.pre_grasp_manipulate import PreGraspManipulate
from ....skills.raise_corner import RaiseCorner
from ....skills.release import Release
from ....skills.retreat import Retreat
from ....skills.segment_and_grasp import SegmentAndGrasp
from ....skills.take_corner import TakeCorner
from ....skills.take_down import TakeDown
from ....skills.unhook import Unhook
from ....skills.view_around import ViewAround
from ...nodes.composers import fallback, sequence
from ...nodes.decorators import Condition, Retry, Stage, Timeout
from .tuning import DRESSING


def take_down(context: Context) -> Behaviour:
    """The stage `take_down`."""
    find_outside = fallback(
        "find the outside",
        FlipSideCheck("outside to the front", context, hung=True, min_confidence=0.0),
        Navigate("go behind the rail", context, goal="rail_back"),
    )
    by_both_ends = sequence(
        "by both ends of the neckline",
        fallback("free hands", Condition("nothing is held", _hands_open), Retreat("let go of both ends", context)),
        take_ends(context),
        TakeDown("lift it off the hook", context, hook=Key("hook")),
    )
    return Stage(
        "A take down",
        None,
        Timeout(
            "A in time",
            sequence(
                "take the gown down",
                Navigate("go to the rail", context, goal="rail"),
                find_outside,
                fallback("take it", Retry("the other end first", by_both_ends, attempts=3), from_one_hand(context)),
            ),
            seconds=DRESSING.take_down_timeout,
        ),
    )


def take_ends(context: Context) -> Behaviour:
    """Both ends of the hung gown's neckline: the one that shows, drawn aside, and then the other one."""
    hook, held, lengths = Key("hook"), Key("held"), (Key("strip"), Key("other_strip"))
    ports = ("corner", "sleeve", "other_sleeve", "hand", "other_hand")
    found = {port: Key(f"found_{port}") for port in ports}
    first, second = found["hand"], found["other_hand"]

    def take(name: str, **ports: object) -> TakeCorner:
        return TakeCorner(
            name,
            context,
            hand=first,
            sleeve=found["sleeve"],
            hook=hook,
            corner=found["corner"],
            length=lengths[0],
            **ports,
        )

    def take_other(how: str, **ports: object) -> TakeCorner:
        return TakeCorner(
            f"take the other corner {how}",
            context,
            hand=second,
            sleeve=found["other_sleeve"],
            hook=hook,
            held_length=held,
            length=lengths[1],
            **ports,
        )

    def complete(context: Context) -> bool:
        """Both strips together are as long as a neckline."""
        shortest, longest = DRESSING.neckline
        return shortest < sum(context.board.get(key.name) for key in lengths) < longest

    return sequence(
        "take both ends",
        FindCorner("look for a corner", context, hook=hook, **found),
        fallback(
            "a corner",
            take("take a corner", opening=DRESSING.corner_opening, depth=DRESSING.corner_depth),
            take("take it deeper", opening=DRESSING.deeper_opening, depth=DRESSING.deeper_depth),
        ),
        RaiseCorner("draw it aside", context, hand=first, hook=hook, held_length=held),
        FlipSideCheck("outside still to the front", context, min_confidence=DRESSING.inside_confidence),
        fallback(
            "the other corner",
            take_other("as it hangs", min_confidence=DRESSING.seen_confidence, opening=DRESSING.other_opening),
            sequence(
                "from farther round",
                RaiseCorner(
                    "draw it farther round",
                    context,
                    hand=first,
                    hook=hook,
                    held_length=held,
                    angle=DRESSING.farther_round,
                ),
                take_other("from farther round"),
            ),
        ),
        Condition("both ends of the neckline", complete, Reason.GRASP_MISSED),
    )


def from_one_hand(context: Context) -> Behaviour:
    """Where the ends do not show on the hook: off it with one hand, turned before the camera, corner by corner."""
    views, holder, former = Key("views"), Key("holder"), Key("former")
    return sequence(
        "from one hand",
        Retreat("let go of the neckline", context),
        SegmentAndGrasp("take it near the hook", context, hand="right"),
        Unhook("lift it off with one hand", context, hand="right"),
        ViewAround("look at it from all sides", context, hand="right", views=views),
        PreGraspManipulate("take one corner", context, views=views, holder=holder, former=former),
        Release("let the place near the hook go", context, hand=former),
        ViewAround("look at it again from all sides", context, hand=holder, views=views),
        PreGraspManipulate("take the other corner", context, views=views, min_distance=DRESSING.nearest_corner),
    )


def _hands_open(context: Context) -> bool:
    """Both grippers stand open [m]."""
    return bool(np.all(context.world.observe().gripper_opening > DRESSING.empty_opening))
