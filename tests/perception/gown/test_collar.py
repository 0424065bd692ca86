"""Corners and middle of the neck binding."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.gown.collar import DEFAULT, collar_middle, corner_candidates, hidden_at, slices_across
from caretree.perception.gown.gown_facts import GOWN
from caretree.perception.image.projection import points_in_map


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
        collar = scene.gown.collar
        middle = scene.vertices[collar[len(collar) // 2]]
        assert abs(grasp.position_in_map[0] - middle[0]) < 0.075, seed  # [m] across the bed
        assert scene.distance_to_cloth(grasp.position_in_map) < 0.015
        assert grasp.approach_in_map[2] < 0
        assert 0.3 < grasp.confidence <= 1.0


def test_cloth_below_the_middle_is_grasped_where_it_lies(scenes):
    scene = scenes.lying(1)
    middle = corner_places(scene).mean(axis=0)
    frame = scene.frame()
    at, below = collar_middle(frame, middle), collar_middle(frame, middle, away=(0.0, 0.08))
    assert (below.position_in_map - at.position_in_map)[:2] == pytest.approx((0.0, 0.08), abs=0.015)
    assert scene.distance_to_cloth(below.position_in_map) < 0.015
    with pytest.raises(PerceptionFailure):
        collar_middle(frame, middle, away=(0.0, 2.0))  # [m]: beyond the hem


HEIGHT = 0.10  # of a neckline above the shoulders [m]


def tape(bend=0.0, end=0.36, sinks=0.0):
    """Points (n, 3) of a neckline from x = -0.36 m to `end`; its left half is in waves, its right one `sinks` [m]."""
    x = np.linspace(-0.36, end, 400)
    y = np.where(x < 0.0, bend * np.sin(x * 60.0), 0.0)
    return np.column_stack([x, y, HEIGHT - sinks * np.clip(x, 0.0, None) / end])


def doubts(points, armholes=None):
    """Doubt in the left end and in the right end, beside which the `armholes` (2, 3) begin by default [m]."""
    step = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    ways = (0, step), (len(points) - 1, step[-1] - step)
    armholes = points[[0, -1]] if armholes is None else armholes
    return [hidden_at(points, end, way, np.zeros(3), armholes, DEFAULT) for end, way in ways]


def test_more_is_hidden_at_an_end_whose_half_is_not_straight():
    left, right = doubts(tape(bend=0.02))
    assert left > 2.0 * right


def test_more_is_hidden_at_an_end_inside_of_the_shoulder_seam():
    left, right = doubts(tape(end=0.20))
    assert right > 2.0 * left


def test_more_is_hidden_at_an_end_that_has_gone_down_beside_a_shoulder():
    left, right = doubts(tape(sinks=0.09))
    assert right > 2.0 * left


def test_more_is_hidden_at_an_end_with_no_armhole_beside_it():
    points = tape()
    left, right = doubts(points, points[:1])
    assert right > 2.0 * left
    left, right = doubts(points, np.zeros((0, 3)))
    assert left == pytest.approx(right), "no armhole shows at all"


def flat_tape(length=0.4, step=0.004):
    """(n, 3) points of a straight tape across the body, and the area of it at each (n,)."""
    along, wide = np.meshgrid(np.arange(0.0, length, step), np.arange(0.0, GOWN.strap_width, step))
    points = np.column_stack([along.ravel(), wide.ravel(), np.zeros(along.size)])
    return points, np.full(len(points), step**2)


ACROSS = np.array((1.0, 0.0, 0.0))


def test_a_fold_that_shows_does_not_shorten_the_tape():
    points, areas = flat_tape()
    folded = np.abs(points[:, 0] - 0.2) < 0.03
    for more in (1.0, 4.0):
        middles, lengths = slices_across([(points, areas * np.where(folded, more, 1.0))], ACROSS, DEFAULT)
        assert lengths.sum() == pytest.approx(0.4 + 0.06 * (more - 1.0), abs=0.03)
        assert len(middles) == len(lengths) == 20


def test_tape_that_hardly_shows_still_reaches_its_neighbours():
    points, areas = flat_tape()
    seen = (points[:, 0] < 0.15) | (points[:, 0] > 0.25)
    _, lengths = slices_across([(points[seen], 0.3 * areas[seen])], ACROSS, DEFAULT)
    assert lengths.sum() == pytest.approx(0.4, abs=0.03)


def test_of_two_pictures_the_one_counts_that_shows_more_of_a_slice():
    points, areas = flat_tape()
    left, right = (np.where(points[:, 0] < 0.2, a, b) * areas for a, b in ((1.0, 0.2), (0.3, 1.0)))
    middles, lengths = slices_across([(points, left), (points, right)], ACROSS, DEFAULT)
    assert lengths.sum() == pytest.approx(0.4, abs=0.03)
    assert np.all(np.diff(middles[:, 0]) > 0.0)


def test_what_is_hidden_from_one_picture_another_one_shows(scenes):
    scene = scenes.lying(1)
    middle = corner_places(scene).mean(axis=0)
    first, second = scene.frame(1), scene.frame(2)
    whole = collar_middle(first, middle)
    half = points_in_map(first)[..., 0] < whole.position_in_map[0] + 0.05
    cut = replace(first, depth=np.where(half, first.depth, 0.0))
    alone, together = collar_middle(cut, middle), collar_middle(cut, middle, beside=(second,))
    assert alone.confidence < 0.8 * whole.confidence
    assert together.confidence > 0.95 * whole.confidence
    assert together.position_in_map[0] == pytest.approx(whole.position_in_map[0], abs=0.02)


def test_tape_that_is_folded_under_does_not_show(scenes):
    scene = scenes.lying(1)
    middle, aside = corner_places(scene).mean(axis=0), []
    for seed in range(8):  # of the noise, with which what is left of the tape tells its middle by 0.01 m more or less
        frame = scene.frame(seed)
        whole = collar_middle(frame, middle)
        points = points_in_map(frame)
        under = np.abs(points[..., 0] - whole.position_in_map[0]) < 0.08
        rest = collar_middle(replace(frame, depth=np.where(under, 0.0, frame.depth)), middle)
        assert rest.confidence == pytest.approx(whole.confidence - 0.10 / GOWN.neckline_length, abs=0.05)
        aside.append(rest.position_in_map[0] - whole.position_in_map[0])
    assert np.mean(aside) == pytest.approx(0.0, abs=0.03)


def test_no_neckline_far_from_the_person(scenes):
    scene = scenes.lying(0)
    with pytest.raises(PerceptionFailure) as far:
        collar_middle(scene.frame(), corner_places(scene).mean(axis=0) + np.array((0, 2.0, 0)))
    assert far.value.kind == "nothing_seen"


def test_nothing(black):
    with pytest.raises(PerceptionFailure):
        corner_candidates(black)
