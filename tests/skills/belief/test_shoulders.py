"""The middle between the shoulders, from arms that were seen once."""

import numpy as np
import pytest
from caretree.skills.belief.shoulders import CollarSeen, between_shoulders, off_middle
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.dressing.check_collar import CheckCollar

from ..bench import LeafBench, beside_bed

MIDDLE = np.mean([lying_posture(side).points_in_map[0] for side in ("left", "right")], axis=0)  # [m]


def test_arms_that_are_not_known_are_looked_for_and_then_remembered():
    looks = []

    def arm(frame, side, **_):
        looks.append(side)
        return lying_posture(side)

    skill = LeafBench(lambda context: CheckCollar("lies well", context), beside_bed(arm=arm)).skill
    skill.initialise()
    assert between_shoulders(skill) == pytest.approx(MIDDLE, abs=1e-6)
    seen = len(looks)
    assert {"left", "right"} <= set(looks)
    assert between_shoulders(skill) == pytest.approx(MIDDLE, abs=1e-6)
    assert len(looks) == seen


def test_aside_is_to_the_right_of_the_bed_less_what_is_seen_too_much_and_headward_away_from_the_feet():
    assert off_middle(MIDDLE + (0.1, -0.2, 0.3), MIDDLE, CollarSeen(aside=0.02)) == pytest.approx((0.08, 0.2))
