"""Corners and middle of the neck binding."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.gown.collar import collar_middle, corner_candidates


def corner_places(scene):
    """Middle of the binding at its two ends (2, 3)."""
    h = scene.gown.spec.spacing
    below = [
        int(np.argmin(np.linalg.norm(scene.gown.vertices - (scene.gown.vertices[c] - (0, 0, h)), axis=1)))
        for c in scene.gown.corners
    ]
    return (scene.vertices[list(scene.gown.corners)] + scene.vertices[below]) / 2


def test_a_confident_corner_is_a_corner(scenes):
    errors = []
    for seed in range(4):
        for turn in np.arange(6) * np.pi / 6:
            scene = scenes.in_hand(seed, turn)
            try:
                ends = corner_candidates(scene.frame(seed))
            except PerceptionFailure:
                continue
            # the other end is in the hand
            free = [end for end in ends if np.linalg.norm(end.position_in_map - scene.hand[:3, 3]) > 0.12]
            if free and free[0].score > 0.4:  # else it is hidden in this view
                errors.append(np.linalg.norm(corner_places(scene) - free[0].position_in_map, axis=1).min())
    assert len(errors) >= 10
    assert np.median(errors) < 0.03
    assert np.mean(np.array(errors) < 0.05) > 0.85


def test_the_middle_of_a_neckline_that_lies_on_the_person(scenes):
    for seed in range(3):
        scene = scenes.lying(seed)
        ends = corner_places(scene)
        grasp = collar_middle(scene.frame(), ends.mean(axis=0))
        away = np.linalg.norm(ends - grasp.position_in_map, axis=1)
        assert abs(away[0] - away[1]) < 0.15, seed  # [m]: as far from one end as from the other
        assert scene.distance_to_cloth(grasp.position_in_map) < 0.015
        assert grasp.approach_in_map[2] < 0
        assert 0.3 < grasp.confidence <= 1.0


def test_no_neckline_far_from_the_person(scenes):
    scene = scenes.lying(0)
    with pytest.raises(PerceptionFailure) as far:
        collar_middle(scene.frame(), corner_places(scene).mean(axis=0) + np.array((0, 2.0, 0)))
    assert far.value.kind == "nothing_seen"


def test_nothing(black):
    with pytest.raises(PerceptionFailure):
        corner_candidates(black)
