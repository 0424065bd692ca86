"""How far up an armhole is, told by what several pictures show of its rim."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.estimates import SleeveProfile
from caretree.perception.sleeve.arm_frame import arm_frame
from caretree.perception.sleeve.sleeve_profile import DEFAULT, reach_of, rim_features, round_arm, sleeve_profile
from caretree.skills.scripted.scripted_person import lying_posture

from .test_worn_sleeve import ARM, picture

SECTORS = DEFAULT.sectors
BELOW = ARM - (0.0, 0.0, 0.05)  # of an arm whose sleeve is what the camera sees


def profile(at, shows=slice(None), cuff=(), cuff_at=0.7):
    """A rim at `at` (sectors,), of which some sectors show, and the cuff of others."""
    seen = np.full(SECTORS, np.nan)
    seen[shows] = np.broadcast_to(at, SECTORS)[shows]
    cuff_seen = np.where(np.isin(np.arange(SECTORS), cuff), cuff_at, np.nan)
    return SleeveProfile(stamp=0.0, confidence=1.0, side="right", armhole_at=seen, cuff_at=cuff_seen)


def slanting(middle=0.3, slant=0.2):
    """A rim that lies at `middle` + `slant` on top of the arm, and as far beyond it underneath (sectors,)."""
    return middle + slant * np.cos((np.arange(SECTORS) + 0.5) * 2.0 * np.pi / SECTORS)


def test_a_stripe_across_an_arm_shows_above_it_where_it_is():
    seen = sleeve_profile(picture((30, 40), (55, 65)), "right", BELOW)
    shows = ~np.isnan(seen.armhole_at)
    assert 3 <= np.count_nonzero(shows) < SECTORS / 2
    assert seen.armhole_at[shows] == pytest.approx(0.25, abs=0.02)
    assert shows[0] or shows[-1], "sectors begin at the top"
    cuff = ~np.isnan(seen.cuff_at)
    assert np.count_nonzero(cuff) >= 3
    assert seen.cuff_at[cuff] == pytest.approx(0.66, abs=0.02)
    assert not shows[SECTORS // 4 : 3 * SECTORS // 4].all(), "nothing shows below"


@pytest.mark.parametrize(("side", "sign"), [("left", -1.0), ("right", 1.0)])
def test_the_frame_of_an_arm_points_along_it_up_and_away_from_the_body(side, sign):
    arm = lying_posture(side).points_in_map
    along, up, out = arm_frame(arm)
    assert along @ (arm[1] - arm[0]) == pytest.approx(np.linalg.norm(arm[1] - arm[0]))
    assert up[2] > 0.9
    assert sign * out[0] > 0.5
    np.testing.assert_allclose(np.stack((along, up, out)) @ np.stack((along, up, out)).T, np.eye(3), atol=1e-9)


def test_what_shows_too_little_is_not_told():
    with pytest.raises(PerceptionFailure):
        sleeve_profile(picture((30, 40), (55, 65), rows=(0, 15)), "right", BELOW)


def test_pictures_of_both_halves_tell_a_slanting_rim_which_one_half_does_not():
    rim = slanting()
    top, below = profile(rim, np.abs(np.arange(SECTORS) - SECTORS / 2) > SECTORS / 4), profile(rim, slice(5, 19))
    assert rim_features([top, below])[0] == pytest.approx(0.7, abs=0.01)
    assert rim_features([top])[0] == pytest.approx(0.7 - 0.12, abs=0.06)
    assert reach_of([top, below]) > reach_of([top]) + 0.05


def test_what_hides_lies_between_what_shows_beside_it():
    rim = slanting(slant=0.1)
    assert rim_features([profile(rim, slice(0, None, 6))]) == pytest.approx((0.7, 1 / 6), abs=0.01)


def test_two_pictures_of_the_same_sector_count_alike():
    assert rim_features([profile(0.2), profile(0.4)]) == pytest.approx((0.7, 1.0))


def test_a_higher_rim_reaches_farther_up_and_no_farther_than_the_shoulder():
    reaches = [reach_of([profile(at)]) for at in (0.6, 0.3, 0.1, -0.5)]
    assert reaches == sorted(reaches)
    assert reaches[0] < 0.6 < reaches[1] < 0.85
    assert reaches[-1] == 1.0
    assert reach_of([replace(profile(0.3), side="left")]) == reach_of([profile(0.3)])


def test_an_armhole_under_its_gathered_sleeve_is_lower_than_it_looks():
    hidden, worn, gathered, turned_in = (
        reach_of([profile(0.3, cuff=cuff, cuff_at=at)])
        for cuff, at in (((), 0.0), ((0, 8), 0.7), ((0, 8), 0.5), ((0, 8), 0.25))
    )
    assert hidden == worn
    assert gathered == pytest.approx(worn - 0.5 * 0.10)
    assert turned_in == pytest.approx(worn - 0.5 * 0.35)


@pytest.mark.parametrize(
    ("cuffs", "share"),
    [
        ([()], 0.0),
        ([(5,)], 1 / SECTORS),
        ([range(SECTORS)], 1.0),
        ([range(12)], 0.5),
        ([(0, 8, 16)], 1 - 7 / SECTORS),
        ([(22, 23, 0, 1)], 4 / SECTORS),  # across the top
        ([range(6), range(12, 18)], 0.75),  # either picture shows a quarter
    ],
)
def test_a_cuff_is_round_the_arm_but_for_the_widest_gap(cuffs, share):
    assert round_arm([profile(0.2, cuff=tuple(cuff)) for cuff in cuffs]) == pytest.approx(share)
