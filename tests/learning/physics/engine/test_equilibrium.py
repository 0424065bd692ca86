from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.physics.engine.equilibrium import NEARER
from caretree.learning.physics.engine.fall import FRAMES, RATE, cut_of, rest, springs_of, steps_per_frame
from caretree.sim.bullet.soft_world import GRAVITY
from caretree.sim.scene.gown import GOWNS
from caretree.sim.spring.mass_spring import advance


def test_the_static_equilibrium_is_at_rest(small_gown):
    """Held by both vertices it stays where it is, for as long as a clip takes."""
    mesh, woven = cut_of(small_gown)
    start = rest(small_gown)
    x, v, free = start.copy(), np.zeros_like(start), np.ones(len(start), bool)
    free[list(mesh.corners)] = False
    steps = steps_per_frame(small_gown, len(start))
    advance(springs_of(small_gown, woven), x, v, free, 1 / RATE / steps, steps * FRAMES)
    assert np.linalg.norm(x - start, axis=1).mean() < 0.003


@pytest.mark.parametrize("name", GOWNS)
def test_the_held_vertices_carry_the_weight(name):
    gown = GOWNS[name]
    mesh, woven = cut_of(gown)
    x, springs = rest(gown), springs_of(gown, woven)
    one = np.repeat(np.arange(len(x)), np.diff(springs.start))
    along = x[springs.other] - x[one]
    length = np.linalg.norm(along, axis=1, keepdims=True)
    pull = springs.stiffness[:, None] * (1 - springs.rest[:, None] / length) * along
    held = np.isin(one, mesh.corners).astype(float) - np.isin(springs.other, mesh.corners)
    own = gown.mass * 2 / len(x) * GRAVITY
    assert -(held @ pull)[2] + own == pytest.approx(gown.mass * GRAVITY, rel=0.02)
    left, right = x[list(mesh.corners)]
    assert right[0] - left[0] == pytest.approx(NEARER * np.ptp(mesh.vertices[list(mesh.corners), 0]))
    np.testing.assert_allclose(left + right, 0.0, atol=1e-12)


def test_a_little_other_gown_hangs_a_little_other():
    """No jumps from one fold to another: ten times the step, about ten times the change."""
    gown = GOWNS["medium"]
    here = rest(gown)
    small, large = (
        np.abs(rest(replace(gown, elastic=gown.elastic * (1 + step))) - here).mean() for step in (0.0025, 0.025)
    )
    assert 0 < small < large < 0.003
    assert large / small == pytest.approx(10.0, rel=0.5)
