"""The front edge of a worn armhole, from pictures painted by hand."""

import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.sleeve.armhole_front import armhole_front

from .test_worn_sleeve import ARM, picture


def lower(arm, by=0.06):
    """The same arm, its axis so far below what is painted [m]."""
    return arm - (0.0, 0.0, by)


def test_it_lies_where_the_tape_crosses_the_top_of_the_arm():
    seen = armhole_front(picture((30, 40), (55, 65), rows=(45, 75)), "right", lower(ARM))
    assert seen.position_in_map == pytest.approx((-0.225, 0.0, 1.0), abs=0.01)
    assert seen.approach_in_map == pytest.approx((0.0, 0.0, -1.0), abs=0.05)
    assert abs(seen.closing_in_map @ (1.0, 0.0, 0.0)) == pytest.approx(1.0, abs=0.05), "along the arm"
    assert seen.target == "sleeve_right"


def test_the_highest_part_of_it_counts_also_beside_the_axis():
    seen = armhole_front(picture((30, 40), (55, 65), rows=(68, 88)), "right", lower(ARM))
    assert abs(seen.position_in_map[1]) == pytest.approx(0.09, abs=0.02)  # [m]


def test_tape_far_beside_the_arm_does_not_count():
    beside = picture((30, 40), (55, 65), rows=(98, 118))  # 19 to 29 cm aside
    with pytest.raises(PerceptionFailure):
        armhole_front(beside, "right", lower(ARM))


def test_tape_under_the_arm_does_not_count():
    with pytest.raises(PerceptionFailure):
        armhole_front(picture((30, 40), (55, 65)), "right", lower(ARM, by=-0.06))
