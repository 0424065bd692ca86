"""How far places are from the person."""

import numpy as np
import pytest
from caretree.skills.geometry.person_zone import HEAD, LEGS, PARTS, TRUNK, WHOLE, PersonZone, body_parts

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


def test_until_all_of_the_person_is_seen_the_bed_counts_too():
    zone = PersonZone(BED)
    place = np.array((0.45, -0.95, 0.55))  # in a corner of the bed
    for part in PARTS:
        assert not zone.known
        assert zone.distance(place) == pytest.approx([0.0])
        zone.update(np.array((0.0, 0.8, 0.7)), part=part, radius=0.1)
    assert zone.known
    assert zone.distance(place) > 1.0  # [m]


def test_a_person_told_as_one_is_all_there_is():
    zone = PersonZone(BED)
    zone.update(np.array((0.0, -0.8, 0.7)), part=WHOLE, radius=0.1)
    assert zone.distance(np.array((0.0, 0.8, 0.7))) == pytest.approx([1.5])  # [m]
    assert zone.names == (WHOLE,)


def test_head_and_trunk_are_expected_in_the_middle_of_the_bed_before_they_are_seen():
    zone = PersonZone(np.array(((-0.5, -1.0, 0.48), (0.5, 1.0, 0.6))))
    assert set(zone.names) == {HEAD, TRUNK, LEGS}
    head = np.array((0.0, -0.75, 0.70))
    gaps, away = zone.gaps(np.array(((head + (0, 0, 0.3), head + (0, 0, 0.3)),)), np.array((0.05,)))
    nearest = int(gaps[0].argmin())
    assert zone.names[nearest] == HEAD
    assert gaps[0, nearest] == pytest.approx(0.3 - 0.05 - zone.radii[nearest], abs=0.02)
    assert away[0, nearest] == pytest.approx((0.0, 0.0, 1.0), abs=0.1)
    zone.update(np.array(((0.2, -0.9, 0.7), (0.2, -0.6, 0.7))), part=HEAD, radius=0.1)
    assert zone.ends[zone.names.index(HEAD), 0] == pytest.approx((0.2, -0.9, 0.7)), "seen elsewhere"


def test_the_trunk_is_as_high_as_it_was_seen_and_lower_at_the_breastbone():
    zone = PersonZone(np.zeros((2, 3)))
    points, radius = body_parts(0.0, -0.86, 0.6, front=0.20, breastbone=0.17)[TRUNK]
    zone.update(points, part=TRUNK, radius=radius)
    # [m] just below the shoulders, at -0.55 where the crown is at -0.86
    assert zone.distance(np.array(((0.10, -0.45, 1.0), (0.0, -0.45, 1.0)))) == pytest.approx((0.20, 0.225), abs=0.01)


def test_a_smaller_person_has_shoulders_nearer_to_the_crown():
    adult, small = (body_parts(0.0, -0.86, 0.6, scale=scale)[HEAD][0] for scale in (1.0, 0.9))
    assert adult[1, 1] - small[1, 1] == pytest.approx(0.023)  # [m]
    assert adult[0] == pytest.approx(small[0])


def test_a_part_that_is_seen_again_has_moved_and_one_forgotten_is_gone():
    zone = PersonZone(np.zeros((2, 3)))
    zone.update(np.zeros(3), part="head", radius=0.1)
    zone.update(np.array((1.0, 0.0, 0.0)), part="head", radius=0.1)
    zone.update(np.array((3.0, 0.0, 0.0)), part="left arm", radius=0.0)
    assert zone.distance(np.array(((0.0, 0.0, 0.0), (2.9, 0.0, 0.0)))) == pytest.approx((0.9, 0.1))  # [m]
    zone.forget("left arm")
    assert not zone.seen("left arm")
    assert zone.distance(np.array((2.9, 0.0, 0.0))) == pytest.approx([1.8])


def test_a_held_arm_turns_about_its_shoulder_with_the_hand():
    zone = PersonZone(np.zeros((2, 3)))
    zone.update(np.array(((0.0, 0, 0), (0.3, 0, 0), (0.55, 0, 0))), part="right arm", radius=0.04)
    zone.update(np.array(((0.0, 1, 0), (0.3, 1, 0), (0.55, 1, 0))), part="left arm", radius=0.04)
    assert zone.nearest_arm(np.array((0.3, 0.1, 0.0))) == "right arm"
    zone.move_arm("right arm", np.array((0.3, 0.0, 0.0)))  # taken at the elbow
    zone.move_arm("right arm", np.array((0.0, 0.0, 0.3)))
    assert zone.distance(np.array((0.0, 0.0, 0.5))) == pytest.approx([0.0])
    assert zone.ends[zone.names.index("right arm") + 1, 1] == pytest.approx((0.0, 0.0, 0.55))
    zone.update(np.array(((0.0, 0, 0), (0.0, 0.3, 0))), part="right arm", radius=0.04)  # seen there
    zone.move_arm("right arm", np.array((0.0, 0.3, 0.0)))
    zone.move_arm("right arm", np.array((0.3, 0.0, 0.0)))
    assert zone.ends[zone.names.index("right arm"), 1] == pytest.approx((0.3, 0.0, 0.0), abs=1e-9)


@pytest.mark.parametrize(("scale", "outside"), [(0.85, 0.185), (1.0, 0.185), (1.1, 0.2035)])
def test_legs_that_lie_flat_end_beyond_the_thighs_of_people_of_any_size(scale, outside):
    points, radius = body_parts(0.1, -0.9, 0.6, scale=scale)[LEGS]
    assert points[:, 0].max() + radius - 0.1 == pytest.approx(outside, abs=0.001)  # [m] from the midline
    assert 0.1 - points[:, 0].min() + radius == pytest.approx(outside, abs=0.001)
