"""Motion that cloth could make, or not."""

import numpy as np
import pytest
from caretree.sim.evaluate.plausibility import depth_inside, edges_of, motion

REST = np.array(((0.0, 0, 0), (1.0, 0, 0), (1.0, 1.0, 0), (0.0, 1.0, 0)))  # [m]
FACES = np.array(((0, 1, 2), (0, 2, 3)))
FAR = np.full((2, 4, 3), 9.0) + np.arange(4)[None, :, None]  # both arms, away from the cloth [m]
RADII = np.full((2, 3), 0.05)  # [m]


def measured(vertices, t, arms=FAR):
    vertices = np.asarray(vertices)
    return motion(np.asarray(t), vertices, FACES, REST, np.repeat(arms[None], len(vertices), axis=0), RADII)


def test_every_edge_counts_once():
    assert edges_of(FACES).tolist() == [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]]


def test_cloth_drawn_out_is_stretched():
    found = measured([REST, 1.2 * REST], [0.0, 1.0])
    assert found.stretch_max == pytest.approx([1.0, 1.2])
    assert found.stretch_p99 == pytest.approx([1.0, 1.2])


def test_speed_is_that_of_the_fastest_vertex_since_the_frame_before():
    moved = REST.copy()
    moved[2, 2] = 0.3
    assert measured([REST, moved, moved], [0.0, 0.1, 0.2]).speed == pytest.approx([0.0, 3.0, 0.0])  # [m/s]


def test_long_runs_are_measured_in_parts_without_a_seam():
    t = 0.1 * np.arange(150)
    found = measured(REST + 0.2 * t[:, None, None] * np.array((0.0, 0.0, 1.0)), t)
    assert found.speed[1:] == pytest.approx(np.full(149, 0.2))  # [m/s]


def test_a_vertex_below_the_skin_is_as_deep_as_it_is_inside():
    start, end = np.array([[0.0, 0.0, 0.0]]), np.array([[1.0, 0.0, 0.0]])
    assert depth_inside(np.array([[[0.5, 0.03, 0.0], [0.5, 0.2, 0.0]]]), start, end, 0.05) == pytest.approx(
        [0.02]
    )  # [m]
    assert depth_inside(np.array([[[1.2, 0.0, 0.0]]]), start, end, 0.05) == pytest.approx([0.0])
    arms = FAR.copy()
    arms[1] = REST[2] + np.array(((-0.5, 0, 0.01), (0.5, 0, 0.01), (0.6, 0, 0.01), (0.7, 0, 0.01)))
    assert measured([REST], [0.0], arms).depth == pytest.approx([0.04])
