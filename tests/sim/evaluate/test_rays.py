"""Where a ray from the skin meets cloth."""

import numpy as np
import pytest
from caretree.sim.evaluate.rays import meets

SHEET = np.array(((0.0, 0, 0), (1.0, 0, 0), (1.0, 1.0, 0), (0.0, 1.0, 0)))  # [m]
UP, DOWN = np.array(((0, 1, 2), (0, 2, 3))), np.array(((0, 2, 1), (0, 3, 2)))
POINT, NORMAL = np.array((0.6, 0.3, 0.0)), np.array((0.0, 0.0, 1.0))


def stack(*heights):
    """(V, 3) sheets of 1 m by 1 m at these heights [m]."""
    return np.concatenate([SHEET + (0.0, 0.0, height) for height in heights])


def test_every_layer_within_reach_is_met_once():
    faces = np.concatenate((UP, DOWN + 4, UP + 8, UP + 12, UP + 16))
    height, outward = meets(stack(0.01, 0.05, 0.3, -0.01, -0.05), faces, POINT, NORMAL, 0.02, 0.25)
    order = np.argsort(height)
    assert height[order] == pytest.approx((-0.01, 0.01, 0.05))
    assert outward[order].tolist() == [True, True, False]


def test_height_is_along_a_normal_that_leans():
    normal = np.array((np.sin(0.5), 0.0, np.cos(0.5)))
    height, _ = meets(stack(0.1), UP, POINT, normal, 0.02, 0.25)
    assert height == pytest.approx([0.1 / np.cos(0.5)])


def test_beside_the_cloth_nothing_is_met():
    assert len(meets(stack(0.1), UP, np.array((1.4, 0.3, 0.0)), NORMAL, 0.02, 0.25)[0]) == 0
