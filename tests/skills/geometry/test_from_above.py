"""A hand comes to cloth on the person from above, and never leans in from across the bed."""

import numpy as np
import pytest
from caretree.perception.image.cloud import unit
from caretree.skills.geometry.from_above import from_above

OUT = np.array((1.0, 0.0, 0.0))
TILT = np.deg2rad(35.0)


def test_straight_down_stays_so():
    assert from_above(np.array((0.0, 0.0, -1.0)), OUT, TILT) == pytest.approx((0.0, 0.0, -1.0))


def test_it_leans_with_the_cloth_as_far_as_it_may():
    slightly = unit(np.array((-0.3, 0.0, -1.0)))
    assert from_above(slightly, OUT, TILT) == pytest.approx(slightly)
    steeply = from_above(unit(np.array((-3.0, 0.0, -1.0))), OUT, TILT)
    assert steeply == pytest.approx((-np.sin(TILT), 0.0, -np.cos(TILT)))


def test_it_does_not_come_from_across_the_bed():
    leaning = from_above(unit(np.array((0.5, 0.5, -1.0))), OUT, TILT)
    assert leaning @ OUT == pytest.approx(0.0)
    assert leaning[1] > 0.3
