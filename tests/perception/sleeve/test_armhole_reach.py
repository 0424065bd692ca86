"""How far up an arm an armhole is, by half of a ring round it."""

import numpy as np
import pytest
from caretree.perception.sleeve.armhole_reach import armhole_reach, reach_features

# a left arm on the bed, towards the feet; x is outwards, y towards the feet
ARM = np.array(((0.2, -0.55, 0.7), (0.28, -0.27, 0.68), (0.35, -0.02, 0.66), (0.38, 0.15, 0.65)))
LENGTH = np.linalg.norm(ARM[1] - ARM[0])
ALONG = (ARM[1] - ARM[0]) / LENGTH
UP = np.array((0.0, 0.0, 1.0)) - ALONG[2] * ALONG
UP = UP / np.linalg.norm(UP)
OUTWARDS = np.cross(UP, ALONG)
FROM_HEAD, FROM_BESIDE = ARM[0] + (0.2, -1.0, 0.6), ARM[0] + (1.0, 0.1, 0.6)
CUFF_BEYOND = 0.10  # of the cuff from the armhole, along the arm [m]


def ring(way, slant=0.0, radius=0.06):
    """(n, 3) upper half of a ring round the arm that meets its axis at `way` [m]; what is higher is nearer the hand."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, 40)
    up, out = radius * np.cos(angle)[:, None], radius * np.sin(angle)[:, None]
    return ARM[0] + (way + slant * up) * ALONG + up * UP + out * OUTWARDS


def test_a_plane_through_what_shows_meets_the_axis_where_the_ring_does():
    meets, upwards, outwards = reach_features(ring(0.08, slant=-0.5), ring(0.2), ARM)[6:]
    assert meets == pytest.approx(0.08, abs=0.015)
    assert -0.5 < upwards < -0.1, "of its slant, less the less there is to tell it by"
    assert outwards == pytest.approx(0.0, abs=0.01)


def test_the_two_arms_are_mirrored():
    mirror = np.array((-1.0, 1.0, 1.0))
    leaning = ring(0.08) + 0.3 * ((ring(0.08) - ARM[0]) @ OUTWARDS)[:, None] * ALONG
    left = reach_features(leaning, ring(0.2), ARM)
    assert abs(left[8]) > 0.1
    assert reach_features(mirror * leaning, mirror * ring(0.2), mirror * ARM) == pytest.approx(left)


@pytest.mark.parametrize("camera", [FROM_HEAD, FROM_BESIDE])
def test_an_armhole_farther_down_the_arm_reaches_less_far_up(camera):
    reach = [armhole_reach(ring(way), ring(way + CUFF_BEYOND), ARM, camera) for way in (0.03, 0.06, 0.09, 0.12)]
    assert np.all(np.diff(reach) < -0.05), "3 cm are a tenth of the upper arm"


def test_where_it_is_seen_from_counts():
    from_head, from_beside = (armhole_reach(ring(0.06), ring(0.16), ARM, at) for at in (FROM_HEAD, FROM_BESIDE))
    assert from_head != pytest.approx(from_beside, abs=0.005)
