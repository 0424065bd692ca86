"""Cloth on the face: the longest time in one piece."""

import numpy as np
import pytest
from caretree.sim.evaluate.face import face_covered

SHEET = np.array(((-1.0, -1, 0.03), (1.0, -1, 0.03), (1.0, 1.0, 0.03), (-1.0, 1.0, 0.03)))  # [m]
FACES = np.array(((0, 1, 2), (0, 2, 3)))
FACE = np.array((0.3, 0.1, 0.0, 0.0, 0.0, 1.0))
T = 0.1 * np.arange(101)  # [s]


def covered(*spans, height=0.0):
    """With the sheet over the face within these spans [s] and beside it else."""
    on = np.zeros(len(T), dtype=bool)
    for first, last in spans:
        on |= (first <= T) & (last >= T)
    vertices = SHEET + np.where(on, 0.0, 5.0)[:, None, None] * np.array((1.0, 0.0, 0.0)) + (0.0, 0.0, height)
    return face_covered(T, vertices, FACES, FACE)


def test_a_face_that_is_never_covered():
    assert covered() == (0.0, 0.0)


def test_the_longest_span_counts_and_they_do_not_add_up():
    lasted, ended = covered((1.0, 1.8), (4.0, 5.4), (7.0, 7.6))
    assert lasted == pytest.approx(1.5, abs=0.11)  # looked at every 0.2 s
    assert ended == pytest.approx(5.4)


def test_cloth_that_is_carried_over_does_not_lie_on_it():
    assert covered((1.0, 5.0), height=0.04)[0] > 3.9
    assert covered((1.0, 5.0), height=0.06)[0] == 0.0
