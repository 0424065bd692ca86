"""The body's shape: what is derived from it fits together."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.quantity import rows
from caretree.sim.scene.person_spec import (
    PERSON_PARTS,
    PERSONS,
    SHAPE,
    PersonSpec,
    arm_part,
    shoulder_in_map,
    torso_front,
    trunk_capsules,
)


@pytest.mark.parametrize("spec", PERSONS.values(), ids=PERSONS)
def test_the_front_lies_on_the_chest(spec):
    front = torso_front(spec, 0.6, (0.01, -0.02))
    assert np.linalg.norm(front[:, 3:], axis=1) == pytest.approx(np.ones(len(front)))
    assert (front[:, 5] > 0.0).all()
    a, b, radius = trunk_capsules(spec, 0.6, (0.01, -0.02))["trunk_left"]
    left = front[front[:, 0] < a[0]]
    distance = np.linalg.norm(left[:, (0, 2)] - a[[0, 2]], axis=1)
    assert distance == pytest.approx(np.full(len(left), radius))
    assert left[:, 1].min() >= a[1]
    assert left[:, 1].max() <= b[1]


def test_left_and_right_mirror_each_other_in_the_order_that_physics_loads_them():
    spec = PERSONS["small"]
    trunk = trunk_capsules(spec, 0.6, (0.0, 0.0))
    assert list(trunk) == ["trunk_left", "leg_left", "trunk_right", "leg_right", "trunk_middle", "neck_head"]
    for part in ("trunk", "leg"):
        for left, right in zip(trunk[f"{part}_left"][:2], trunk[f"{part}_right"][:2], strict=True):
            np.testing.assert_array_equal(left * (-1, 1, 1), right)
    left, right = (shoulder_in_map(spec, side, 0.6, (0.0, 0.0)) for side in ("left", "right"))
    np.testing.assert_array_equal(left * (-1, 1, 1), right)
    assert left[0] == pytest.approx(-0.186)


def test_segments_scale_and_weigh_what_the_body_does():
    spec = PersonSpec(scale=1.1, mass=20.0)
    assert spec.arm_lengths == pytest.approx((0.308, 0.275, 0.187))
    assert spec.arm_radii == pytest.approx((0.0396, 0.0363, 0.0297))
    assert spec.trunk_mass + 2 * spec.arm_masses.sum() == pytest.approx(20.0)


def test_parts_of_the_arms_are_found_by_their_names():
    assert PERSON_PARTS[arm_part(0, 0)] == "left_upper_arm"
    assert PERSON_PARTS[arm_part(1, 2)] == "right_hand"
    assert len(PERSON_PARTS) == 9


def test_every_number_of_the_shape_says_where_it_comes_from():
    assert all(row.source.startswith(("choice: ", "paper: ")) for row in rows(SHAPE))


@pytest.mark.parametrize(("change", "says"), [({"scale": 1.3}, "1.3"), ({"mass": 0.0}, "positive")])
def test_bodies_out_of_range_are_refused(change, says):
    with pytest.raises(CaretreeError, match=says):
        PersonSpec(**change)
