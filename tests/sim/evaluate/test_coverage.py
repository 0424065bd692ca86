"""How much of the torso's front lies under cloth, and which way out."""

import numpy as np
import pytest
from caretree.sim.evaluate.coverage import coverage

FACES = np.array(((0, 1, 2), (0, 2, 3)))  # counter-clockwise seen from above: the outside is up
TORSO = np.array([(x, y, 0.0, 0.0, 0.0, 1.0) for x in (0.25, 0.75, 1.25, 1.75) for y in (0.3, 0.6)])  # [m], normals up


def sheet(height):
    """A square of 1 m by 1 m over half of the torso's points."""
    return np.array(((0.0, 0.0, height), (1.0, 0.0, height), (1.0, 1.0, height), (0.0, 1.0, height)))


def test_a_sheet_over_half_of_it():
    assert coverage(sheet(0.02), FACES, TORSO) == pytest.approx((0.5, 1.0))


def test_the_same_sheet_with_its_inside_out():
    assert coverage(sheet(0.02), FACES[:, ::-1], TORSO) == pytest.approx((0.5, 0.0))


def test_of_two_sheets_the_upper_one_is_seen():
    both = np.concatenate((sheet(0.02), sheet(0.05)))
    faces = np.concatenate((FACES[:, ::-1], FACES + 4))
    assert coverage(both, faces, TORSO) == pytest.approx((0.5, 1.0))


@pytest.mark.parametrize("height", [0.4, -0.1], ids=["far above", "below the skin"])
def test_cloth_that_does_not_lie_on_the_torso_covers_nothing(height):
    assert coverage(sheet(height), FACES, TORSO) == (0.0, 0.0)


def test_a_sheet_that_rises_covers_as_far_as_it_lies():
    tent = sheet(0.02)
    tent[1:3, 2] = 0.8  # [m]: 0.2 m over the points at x = 0.25, 0.6 m over those at x = 0.75
    assert coverage(tent, FACES, TORSO) == pytest.approx((0.25, 1.0))
