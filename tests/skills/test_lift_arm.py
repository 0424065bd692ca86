"""Where a lifted arm ends."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.skills.geometry.stances import HEADWARD, outwards
from caretree.skills.lift_arm import LiftGoal, lifted
from caretree.skills.scripted.scripted_person import lying_posture


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("spread", [0.85, 0.0])
def test_it_is_raised_and_spread_and_never_drawn_in(side, spread):
    posture = lying_posture(side)
    first = posture.points_in_map[1] - posture.points_in_map[0]
    now = np.arctan2(first @ outwards(side), first @ -HEADWARD)
    way = lifted(posture, side, LiftGoal(grip_coordinate=1.0, pitch=np.deg2rad(35.0), spread=spread))
    assert np.linalg.norm(way) == pytest.approx(1.0)
    assert np.arctan2(way @ outwards(side), way @ -HEADWARD) == pytest.approx(max(now, spread))
    assert way[2] > first[2] / np.linalg.norm(first) + 0.3


def test_an_arm_that_is_up_stays_as_high():
    posture = lying_posture("right")
    raised = posture.points_in_map[0] + np.outer(np.linspace(0.0, 0.7, 4), (0.3, 0.4, 0.75**0.5))
    way = lifted(
        replace(posture, points_in_map=raised),
        "right",
        LiftGoal(grip_coordinate=1.0, pitch=np.deg2rad(35.0), spread=0.85),
    )
    assert way[2] == pytest.approx(0.75**0.5)
