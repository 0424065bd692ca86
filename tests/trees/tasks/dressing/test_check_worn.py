"""Whether what was seen closely tells that a sleeve sits on an arm that lies."""

from dataclasses import replace

import pytest
from caretree.sim.scene.scene import room_map
from caretree.skills.belief.close_look import CLOSE_LOOK, CloseLook, SleeveSeen
from caretree.skills.core.reasons import Reason
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.dressing.check_worn import CheckWorn

from ....skills.bench import LeafBench, beside_bed

LYING = lying_posture("left")


def raised(height):
    """The left arm, its joints beyond the shoulder at such a height above the mattress [m]."""
    points = LYING.points_in_map.copy()
    points[1:, 2] = room_map().bed[1, 2] + height
    return replace(LYING, points_in_map=points)


@pytest.mark.parametrize(
    ("reach", "round_arm", "age", "arm", "reason"),
    [
        (0.75, 0.6, 0.0, LYING, None),
        (0.71, 0.6, 0.0, LYING, Reason.SLEEVE_LOW),
        (0.75, 0.5, 0.0, LYING, Reason.NOTHING_SEEN),
        (0.75, 0.6, 1.1 * CLOSE_LOOK.sleeves_last, LYING, Reason.NOTHING_SEEN),
        (0.75, 0.6, 0.0, raised(0.12), None),  # as high as `LowerArm` leaves an arm
        (0.75, 0.6, 0.0, raised(0.16), Reason.ARM_SLIPPED),
    ],
)
def test_a_sleeve_sits_where_armhole_cuff_and_arm_say_so(reach, round_arm, age, arm, reason):
    run = LeafBench(lambda context: CheckWorn("worn", context, side="left", min_reach=0.73), beside_bed(arm=arm))
    CloseLook.of(run.skill).sleeves["left"] = SleeveSeen(reach, round_arm, run.skill.now() - age)
    assert run.ended(seconds=1.0) == reason


def test_a_sleeve_that_nobody_looked_at_closely_is_not_told():
    run = LeafBench(lambda context: CheckWorn("worn", context, side="left", min_reach=0.73), beside_bed(arm=LYING))
    assert run.ended(seconds=1.0) == Reason.NOTHING_SEEN
