"""Both hands draw apart before the chest until the neckline between them pulls back."""

import numpy as np
import pytest
from caretree.sim.world import SIDES
from caretree.skills.core.reasons import Reason
from caretree.skills.stretch_neckline import StretchNeckline, StretchNecklineTuning

from .hung_gown import DOWN, LEFT, at, bench_with, ended, hand_from_base, holding

ARMS = holding(left=at(0.70, 0.25, 1.15), right=at(0.70, -0.25, 1.15))
MIDDLE = at(0.0, 0.0, 0.0) @ LEFT  # of the robot [m]


def bench(taut_at, weights=(2.0, 2.0), *, stiffness=50.0, **ports):
    """A neckline that pulls back by `stiffness` [N/m] on each hand at more than `taut_at` apart [m]; weights in [N]."""

    def pull(side, hand):
        aside = hand @ LEFT - MIDDLE
        stretch = np.sign(aside) * max(abs(aside) - taut_at / 2, 0.0)
        return weights[SIDES.index(side)] * DOWN - stiffness * stretch * LEFT

    return bench_with(lambda context: StretchNeckline("stretch", context, **ports), arms=ARMS, pull=pull)


def apart(world):
    """Where both hands are, left and right, in the frame of the base (3,) [m]."""
    return hand_from_base(world, "left"), hand_from_base(world, "right")


def test_draws_until_the_neckline_pulls_back_and_tells_its_width():
    run = bench(taut_at=0.70, max_load=1.0)  # [N]: reached by 2 cm on each side
    assert ended(run) is None
    left, right = apart(run.world)
    assert left[1] - right[1] == pytest.approx(0.75, abs=0.02)  # [m]: and half a tick's way
    assert run.skill.width == pytest.approx(left[1] - right[1], abs=0.02)


def test_holds_it_level_before_the_chest():
    run = bench(taut_at=0.70)
    assert ended(run) is None
    left, right = apart(run.world)
    assert left == pytest.approx(right * (1.0, -1.0, 1.0), abs=0.02)  # [m]
    assert left[2] == pytest.approx(1.36, abs=0.02)  # [m] above the floor
    assert 0.5 < left[0] < 0.75  # [m] ahead of the base


def test_a_wider_gown_is_drawn_no_farther_than_it_may():
    run = bench(taut_at=2.0, max_width=0.65)
    assert ended(run) is None
    assert run.skill.width == pytest.approx(0.65, abs=0.02)  # [m]


def test_a_hand_that_lost_the_gown_is_noticed():
    run = bench(taut_at=2.0, weights=(2.0, 0.2))
    assert ended(run) == Reason.CLOTH_SLIPPED
    assert "right" in run.skill.failure.detail


def test_hands_that_stay_near_each_other_do_not_hold_both_ends():
    run = bench(taut_at=0.70, max_load=1.0, min_width=0.81)
    assert ended(run) == Reason.GRASP_MISSED
    assert "0.7" in run.skill.failure.detail


def test_hands_as_far_apart_as_its_ends_do():
    run = bench(taut_at=0.84, max_load=1.0, min_width=0.81)
    assert ended(run) is None


def test_less_cloth_than_hands_are_first_held_apart_is_not_overstretched():
    first = StretchNecklineTuning(half_width=0.35)  # [m]: 18 N on each hand
    run = bench(taut_at=0.52, stiffness=200.0, min_width=0.7, tuning=first)
    assert ended(run) == Reason.GRASP_MISSED
    left, right = apart(run.world)
    assert left[1] - right[1] < 0.63  # [m]: 11 N


@pytest.mark.parametrize(("weights", "reason"), [((1.3, 3.5), Reason.GRASP_MISSED), ((2.0, 2.8), None)])  # [N]
def test_hands_that_share_the_weight_unevenly_do_not_hold_both_ends(weights, reason):
    run = bench(taut_at=0.84, weights=weights, max_load=1.0, min_width=0.81)
    assert ended(run) == reason
