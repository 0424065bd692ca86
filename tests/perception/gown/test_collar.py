"""Line, corners and shoulder part of the neck binding."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.gown.collar import collar_corner, collar_line, collar_near_shoulder, corner_candidates
from caretree.perception.image.cloud import project


def corner_places(scene):
    """Middle of the binding at its two ends (2, 3)."""
    h = scene.gown.spec.spacing
    below = [
        int(np.argmin(np.linalg.norm(scene.gown.vertices - (scene.gown.vertices[c] - (0, 0, h)), axis=1)))
        for c in scene.gown.corners
    ]
    return (scene.vertices[list(scene.gown.corners)] + scene.vertices[below]) / 2


@pytest.mark.parametrize("seed", range(3))
def test_line_of_a_stretched_gown(scenes, seed):
    scene = scenes.stretched(seed, outside=seed % 2 == 0)
    line = collar_line(scene.frame(seed))
    true_length = 0.96 * len(scene.gown.collar[1:]) * scene.gown.spec.spacing
    assert line.length == pytest.approx(true_length, rel=0.12)
    assert line.straightness > 0.93  # the softest gown's neckline sags by its own weight
    assert line.whole.all()
    ends = corner_places(scene)
    gaps = np.linalg.norm(line.points_in_map[[0, -1], None] - ends, axis=-1)
    assert min(gaps[0, 0] + gaps[1, 1], gaps[0, 1] + gaps[1, 0]) / 2 < 0.04
    assert project(scene.frame(), line.points_in_map[0])[0, 0] < project(scene.frame(), line.points_in_map[-1])[0, 0]


def test_line_of_a_hanging_gown_is_not_level(scenes):
    line = collar_line(scenes.in_hand(0).frame())
    assert np.ptp(line.points_in_map[[0, -1], 2]) > 0.15


def test_a_confident_corner_is_a_corner(scenes):
    errors = []
    for seed in range(4):
        for turn in np.arange(6) * np.pi / 6:
            scene = scenes.in_hand(seed, turn)
            try:
                corner = collar_corner(scene.frame(seed), "left", exclude=scene.hand[:3, 3], below=0.4)
            except PerceptionFailure:  # hidden in this view
                continue
            errors.append(np.linalg.norm(corner_places(scene) - corner.position_in_map, axis=1).min())
            assert corner.target == "collar_corner_left"
    assert len(errors) >= 10
    assert np.median(errors) < 0.03
    assert np.mean(np.array(errors) < 0.05) > 0.85


def test_the_excluded_end_is_not_returned(scenes):
    scene = scenes.in_hand(0)
    best = corner_candidates(scene.frame())[0].position_in_map
    try:
        other = collar_corner(scene.frame(), "right", exclude=best)
    except PerceptionFailure:
        return
    assert np.linalg.norm(other.position_in_map - best) > 0.12


def test_near_the_shoulder(scenes):
    scene = scenes.lying(0)
    frame = scene.frame()
    shoulder = scene.arms["right"][0]
    grasp = collar_near_shoulder(frame, "right", shoulder)
    away = np.linalg.norm(project(frame, grasp.position_in_map)[0, :2] - project(frame, shoulder)[0, :2])
    assert away <= 151 * frame.intrinsics[0] / 466
    assert scene.distance_to_cloth(grasp.position_in_map) < 0.015
    assert grasp.approach_in_map[2] < 0
    with pytest.raises(PerceptionFailure) as far:
        collar_near_shoulder(frame, "right", shoulder + np.array((0, 2.0, 0)))
    assert far.value.kind == "out_of_reach"


def test_nothing(black):
    for function in (collar_line, corner_candidates):
        with pytest.raises(PerceptionFailure):
            function(black)
