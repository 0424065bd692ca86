"""How far places are from the person."""

import numpy as np
import pytest
from caretree.trees.guard.person_zone import PersonZone

BED = np.array(((-0.5, -1.0, 0.5), (0.5, 1.0, 0.6)))  # [m]


def test_distance_to_a_chain_is_to_its_links_not_only_its_points():
    zone = PersonZone(np.zeros((2, 3)))
    zone.update(np.array(((0, 0, 0), (1.0, 0, 0), (1.0, 1.0, 0))), part="arm", radius=0.1)
    got = zone.distance(np.array(((0.5, 0, 0.3), (1.0, 0.5, 0.0), (2.0, 1.0, 0.0), (-0.3, 0.4, 0))))
    np.testing.assert_allclose(got, (0.2, 0.0, 0.9, 0.4), atol=1e-9)


def test_before_anybody_is_seen_the_bed_and_what_is_above_it_count():
    zone = PersonZone(BED, above_bed=0.3)
    got = zone.distance(np.array(((0.0, 0.0, 0.8), (0.0, 0.0, 1.1), (0.9, 0.0, 0.7))))
    assert got == pytest.approx((0.0, 0.2, 0.4))  # [m]


def test_once_a_part_is_seen_the_bed_no_longer_counts():
    zone = PersonZone(BED)
    zone.update(np.array((0.0, -0.8, 0.7)), part="head", radius=0.1)
    assert zone.distance(np.array((0.0, 0.8, 0.7))) == pytest.approx([1.5])  # [m]


def test_a_part_that_is_seen_again_has_moved():
    zone = PersonZone(BED)
    zone.update(np.zeros(3), part="head", radius=0.1)
    zone.update(np.array((1.0, 0.0, 0.0)), part="head", radius=0.1)
    zone.update(np.array((3.0, 0.0, 0.0)), part="hand", radius=0.0)
    assert zone.distance(np.array(((0.0, 0.0, 0.0), (2.9, 0.0, 0.0)))) == pytest.approx((0.9, 0.1))  # [m]
