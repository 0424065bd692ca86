"""Fingers of the spring engine: where a triangle is nearest to a box, and what keeps them apart."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.sim.spring.fingers import near_boxes, nearest, push_aside

HALF = np.array((0.011, 0.005, 0.019))  # of a finger [m]
STEP, MARGIN = 0.0025, 0.006


def outside(place: np.ndarray) -> np.ndarray:
    """How far places (n, 3) are from the box."""
    return np.linalg.norm(np.maximum(np.abs(place) - HALF, 0.0), axis=-1)


def test_nearest_points_are_those_of_a_search_everywhere() -> None:
    rng = np.random.default_rng(3)
    grid = np.array([(i, j, 60 - i - j) for i in range(61) for j in range(61 - i)]) / 60.0
    for _ in range(200):
        corners = rng.normal(0.0, 0.03, 3) + rng.normal(0.0, 0.03, (3, 3))
        share, away = np.empty(3), np.empty(3)
        gap = nearest(corners, HALF, share, away)
        best = outside(grid @ corners).min()
        assert share.min() > -1e-9
        assert share.sum() == pytest.approx(1.0)
        assert np.linalg.norm(away) == pytest.approx(1.0)
        if best > 0.002:
            assert gap == pytest.approx(outside(share @ corners), abs=1e-9)
            assert gap < best + 3e-4


@pytest.mark.parametrize("aside", [0.0, 0.007, 0.013])
def test_a_loose_triangle_is_pushed_before_the_margin(aside: float) -> None:
    corners = np.array(((0.03, 0.0, 0.0), (-0.02, 0.03, 0.0), (-0.02, -0.02, 0.0))) + (aside, 0.0, 0.04)
    x, v, loose, faces = corners.copy(), np.zeros((3, 3)), np.full(3, 2000.0), np.array([[0, 1, 2]])
    box, speeds = np.concatenate([np.zeros(3), HALF, np.eye(3).ravel()])[None], np.zeros((1, 6))
    speeds[0, 2] = 0.25
    pairs = np.empty((1, 2), np.int64)
    for _ in range(60):
        count = near_boxes(x, faces, box, 0.03, pairs)
        if count:
            push_aside(x, v, loose, faces, pairs[:count], box, speeds, 0.2, MARGIN, STEP, 3)
        x += STEP * v
        box[0, 2] += STEP * speeds[0, 2]
    gap = nearest(x - box[0, :3], HALF, np.empty(3), np.empty(3))
    assert gap > MARGIN - 1e-4
    assert gap < MARGIN + 0.02  # it was met
    assert x[:, 2].mean() > 0.045
