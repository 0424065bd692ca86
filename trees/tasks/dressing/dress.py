"""The stages `dress` and `spread` of the dressing tree, and what is owed whenever a stage fails.

dress   the right arm, see that the left sleeve is on its side, drive round the foot of the bed, dress the left arm
spread  draw the collar to the neck where the chest shows, and sleeves that have slipped up their arms once more
"""

from __future__ import annotations

import numpy as np
from py_trees.behaviour import Behaviour

from ....sim.world import SIDES, Side
from ....skills.carry_across import CarryAcross
from ....skills.core.context import Context
from ....skills.core.ports import Key
from ....skills.core.reasons import Reason
from ....skills.geometry.stances import PULLING, stance
from ....skills.look_at_person import LookAtPerson
from ....skills.navigate import Navigate
from ....skills.release_arm import ReleaseArm
from ....skills.retreat import Retreat
from ....skills.spread import Spread
from ...nodes.composers import fallback, sequence
from ...nodes.decorators import Condition, Retry, Stage, Timeout
from .dress_arm import back_off, dress_arm
from .settle_sleeve import settle_sleeve
from .tuning import DRESSING, FIRST_SLEEVE, SECOND_SLEEVE


def dress(context: Context) -> Behaviour:
    """The stage `dress`."""
    bring_across = fallback(
        "bring the left sleeve to its side",
        CarryAcross("carry the left sleeve across", context, side="left"),
        back_off(context, "leave the left sleeve where it is", 0.0),
    )
    go_round = Navigate("drive round the foot of the bed", context, goal="bed_left")
    return Stage(
        "C dress",
        None,
        Timeout(
            "C in time",
            sequence(
                "dress both arms",
                Retreat("bring the arms back", context, hand_distance=DRESSING.arms_back),
                Navigate("go to the right side", context, goal="bed_right"),
                dress_arm(context, "right", FIRST_SLEEVE),
                bring_across,
                go_round,
                dress_arm(context, "left", SECOND_SLEEVE),
            ),
            seconds=DRESSING.dress_timeout,
        ),
    )


def spread(context: Context) -> Behaviour:
    """The stage `spread`: where the chest is not covered, the collar is drawn on the left, then on the right."""
    order: tuple[tuple[Side, str], ...] = (("left", "bed_left"), ("right", "bed_right"))
    sides: list[Behaviour] = []
    for side, waypoint in order:
        draw = sequence(
            f"draw the collar to the {side} shoulder",
            Navigate(f"go to the {side} shoulder", context, goal=waypoint),
            Navigate(f"stand by the {side} shoulder", context, goal=stance(side, "shoulder")),
            LookAtPerson(f"look at the {side} shoulder", context, side=side, posture=Key(f"{side}_near")),
            Retry(
                f"spread again, {side}",
                Spread(
                    f"spread to the {side} shoulder",
                    context,
                    side=side,
                    hand=PULLING[side],
                    grasp=Key(f"{side}_collar"),
                ),
                attempts=2,
            ),
            Retreat(f"leave the {side} shoulder", context, base_distance=DRESSING.shoulder_back_off),
        )
        as_it_is = Retreat(f"leave the {side} shoulder as it is", context, base_distance=DRESSING.shoulder_back_off)
        sides.append(fallback(f"the {side} shoulder, as far as it goes", draw, as_it_is))

    def covered(name: str) -> Behaviour:
        return Condition(name, _chest_covered, Reason.NOTHING_SEEN)

    return Stage(
        "D spread",
        None,
        Timeout(
            "D in time",
            sequence(
                "spread and settle",
                fallback(
                    "spread the gown",
                    covered("it lies spread already"),
                    sequence("draw it straight", *sides, covered("the chest is covered")),
                ),
                *(settle_sleeve(context, arm) for arm in ("left", "right")),
            ),
            seconds=DRESSING.spread_timeout,
        ),
    )


def make_safe(context: Context) -> Behaviour:
    """What is owed whenever a stage fails: lower a held arm, let go, back off, stop."""
    return sequence(
        "make safe",
        *(
            fallback(
                f"safe: {side} hand",
                ReleaseArm(f"safe: {side} hand lowers the arm", context, hand=side, lower=True),
                ReleaseArm(f"safe: {side} hand opens", context, hand=side),
            )
            for side in SIDES
        ),
        Retreat("safe: let go and back off", context, base_distance=DRESSING.safe_back_off, ready=False),
    )


def _chest_covered(context: Context) -> bool:
    """The head camera sees gown on most of the trunk, which lies where the map's bed says."""
    bed = context.world.room.bed
    shoulders = np.array((*bed[:, :2].mean(axis=0), bed[1, 2])) + DRESSING.shoulders_on_bed
    cover = context.senses.chest_cover(context.world.look("head"), shoulders_in_map=shoulders)
    return cover.share > DRESSING.covered_share
