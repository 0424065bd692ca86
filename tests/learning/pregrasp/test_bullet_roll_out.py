"""PyBullet and the spring engine do the same to a gown that fingers push."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.learning.pregrasp.bullet_roll_out import bullet_roll_out
from caretree.learning.pregrasp.hung_state import hang
from caretree.learning.pregrasp.roll_out import roll_out
from caretree.sim.pregrasp.action import path_to
from caretree.sim.pregrasp.numbers import PRIMITIVES, VIEWS


@pytest.mark.parametrize(("seed", "view", "primitive"), [(102, 5, "direct"), (104, 5, "direct"), (106, 2, "move_left")])
def test_both_engines_push_the_cloth_the_same_way(seed: int, view: int, primitive: str) -> None:
    state = hang(seed)
    path = path_to(state.vertices[state.wanted].astype(float), view * VIEWS.turn, PRIMITIVES.index(primitive))
    spring, bullet = roll_out(state, path), bullet_roll_out(state, path)
    apart = np.linalg.norm(spring.vertices - bullet.vertices, axis=1)
    moved = np.linalg.norm(bullet.vertices - state.vertices, axis=1)
    assert np.median(apart) < 0.002
    assert apart.max() < 0.02
    assert moved.max() > 0.01  # the fingers have met it
    assert (spring.layers, spring.corner) == (bullet.layers, bullet.corner)
