"""Nearest points of capsules against trying all of them."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.sim.bullet.contact_pairs import FAR, Capsules, overlaps


def capsules(ends: np.ndarray, radius: float, speed: np.ndarray | None = None) -> Capsules:
    speed = np.zeros_like(ends) if speed is None else speed
    return Capsules(ends=ends, speed=speed, radii=np.full(len(ends), radius))


def distance(one: np.ndarray, other: np.ndarray) -> float:
    """Of two segments (2, 3), by trying 161 x 161 points."""
    share = np.linspace(0.0, 1.0, 161)[:, None]
    a, b = one[0] + share * (one[1] - one[0]), other[0] + share * (other[1] - other[0])
    return float(np.linalg.norm(a[:, None] - b[None], axis=2).min())


def test_overlaps_are_those_that_one_finds_by_trying():
    generator = np.random.default_rng(4)
    robot, person = (generator.normal(0, 0.15, (n, 1, 3)) + generator.normal(0, 0.1, (n, 2, 3)) for n in (12, 9))
    found = overlaps(capsules(robot, 0.05), capsules(person, 0.08), np.zeros((12, 9), bool))
    apart = np.array([[distance(a, b) for b in person] for a in robot]) - 0.13
    deep = {(int(i), int(j)) for i, j in zip(*np.nonzero(apart < -1e-3), strict=True)}
    assert len(deep) > 3
    assert deep <= set(zip(found.robot.tolist(), found.person.tolist(), strict=True))
    assert found.depth == pytest.approx(-apart[found.robot, found.person], abs=1e-3)
    assert found.gap == pytest.approx(apart.min(), abs=1e-3)
    assert np.linalg.norm(found.normal, axis=1) == pytest.approx(1.0)


def test_the_point_is_midway_between_the_skins_and_the_normal_leads_out_of_the_person():
    robot = np.array([[[-0.2, 0.0, 0.14], [0.2, 0.0, 0.14]]])
    person = np.array([[[0.05, -0.3, 0.0], [0.05, 0.3, 0.0]]])
    turning = np.array([[[0.0, 0.0, -0.4], [0.0, 0.0, 0.4]]])
    found = overlaps(capsules(robot, 0.05, turning), capsules(person, 0.10), np.zeros((1, 1), bool))
    assert found.normal[0] == pytest.approx((0.0, 0.0, 1.0), abs=1e-9)
    assert found.point[0] == pytest.approx((0.05, 0.0, 0.095), abs=1e-9)
    assert found.speed[0] == pytest.approx(
        (0.0, 0.0, 0.1), abs=1e-9
    )  # of the robot where it touches, not in its middle


def test_axes_that_meet_are_parted_upwards():
    crossed = np.array([[[-1.0, 0, 0], [1.0, 0, 0]]]), np.array([[[0, -1.0, 0], [0, 1.0, 0]]])
    found = overlaps(capsules(crossed[0], 0.05), capsules(crossed[1], 0.05), np.zeros((1, 1), bool))
    assert found.normal[0] == pytest.approx((0.0, 0.0, 1.0))
    assert found.depth[0] == pytest.approx(0.10)


def test_ignored_pairs_are_not_there():
    ends = np.array([[[0.0, 0, 0], [0.1, 0, 0]]])
    found = overlaps(capsules(ends, 0.05), capsules(ends, 0.05), np.ones((1, 1), bool))
    assert len(found.depth) == 0
    assert found.gap == np.inf


def test_far_away_the_gap_is_no_larger_than_the_distance():
    generator = np.random.default_rng(1)
    for _ in range(50):
        one, other = generator.normal(0, 0.3, (1, 2, 3)), generator.normal(0, 0.3, (1, 2, 3)) + (1.5, 0, 0)
        found = overlaps(capsules(one, 0.05), capsules(other, 0.05), np.zeros((1, 1), bool))
        true = distance(one[0], other[0]) - 0.1
        assert found.gap <= true + 1e-3
        assert found.gap > FAR or found.gap == pytest.approx(true, abs=1e-3)
