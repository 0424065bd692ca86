"""The fast engine against PyBullet, and against laws it must keep."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.physics.engine.bullet import bullet_fall
from caretree.learning.physics.engine.fall import cut_of, fall, rest, springs_of
from caretree.sim.bullet.soft_world import GRAVITY
from caretree.sim.scene.gown import GOWNS, build_gown, edge_counts
from caretree.sim.spring.mass_spring import advance, weave


@pytest.mark.parametrize(
    "gown",
    [
        replace(GOWNS["medium"], bending=0.3, damping=0.002),
        replace(GOWNS["light"], mass=0.2, damping=0.02),
    ],
    ids=["springy", "dull"],
)
def test_it_falls_like_the_gown_of_pybullet(gown):
    start = rest(gown)
    mine, theirs = (engine(gown, start, 6, 0.0) for engine in (fall, bullet_fall))
    way = np.linalg.norm(mine[-1] - mine[0], axis=1)
    assert way.max() > 0.1  # it does fall
    assert np.linalg.norm(mine - theirs, axis=2).max() < 3e-4


def test_with_the_clamp_the_two_stay_close(still_air):
    start = rest(still_air)
    mine, theirs = (engine(still_air, start, 6) for engine in (fall, bullet_fall))
    assert np.linalg.norm(mine - theirs, axis=2).mean() < 0.005


def test_springs_are_bullets(small_gown):
    mesh = build_gown(small_gown)
    woven = weave(mesh)
    edges = {tuple(edge) for edge in edge_counts(mesh.sewn)}
    one = np.repeat(np.arange(len(mesh.vertices)), np.diff(woven.start))
    near = {(int(a), int(b)) for a, b, bend in zip(one, woven.other, woven.bends, strict=True) if a < b and not bend}
    far = {(int(a), int(b)) for a, b, bend in zip(one, woven.other, woven.bends, strict=True) if a < b and bend}
    assert near == edges
    assert not near & far
    sides = {}
    for a, b in edges:
        sides.setdefault(a, set()).add(b)
        sides.setdefault(b, set()).add(a)
    assert all(sides[a] & sides[b] for a, b in far)  # two edges apart
    np.testing.assert_allclose(
        woven.area.sum(),
        sum(0.5 * np.linalg.norm(np.cross(*(mesh.vertices[face[1:]] - mesh.vertices[face[0]]))) for face in mesh.faces),
    )


def moving(gown, seed=0):
    mesh, woven = cut_of(gown)
    x = mesh.vertices.copy()
    v = np.random.default_rng(seed).normal(0.0, 0.5, x.shape)
    return springs_of(gown, woven), x, v, np.ones(len(x), bool)


def test_in_free_fall_the_middle_follows_gravity_whatever_the_springs_do(still_air):
    springs, x, v, free = moving(still_air)
    middle, speed = x.mean(axis=0), v.mean(axis=0)
    advance(springs, x, v, free, 0.001, 100)
    np.testing.assert_allclose(v.mean(axis=0), speed - (0.0, 0.0, 0.1 * GRAVITY), atol=1e-5)
    np.testing.assert_allclose(
        x.mean(axis=0), middle + 0.1 * speed - (0, 0, GRAVITY * 0.001**2 * 100 * 101 / 2), atol=1e-5
    )


def test_damping_takes_away_relative_speed_and_no_turn_of_it_comes_back(still_air):
    slow = replace(still_air, elastic=1e-6, bending=0.0, damping=0.02)
    springs, x, v, free = moving(slow)
    spread = [float((v - v.mean(axis=0)).std())]
    for _ in range(3):
        advance(springs, x, v, free, 0.001, 10)
        spread.append(float((v - v.mean(axis=0)).std()))
    assert spread[0] > spread[1] > spread[2] > spread[3]


def test_in_air_a_gown_reaches_the_speed_at_which_drag_carries_it(small_gown):
    gown = replace(small_gown, air_drag=3.0)
    springs, x, v, free = moving(gown)
    v[:] = 0.0
    advance(springs, x, v, free, 0.002, 1500)
    drag = (gown.air_drag * springs.area * np.linalg.norm(v, axis=1) * -v[:, 2]).sum()
    assert drag == pytest.approx(gown.mass * GRAVITY, rel=0.02)


def test_held_vertices_stay(small_gown):
    mesh, woven = cut_of(small_gown)
    x, v, free = mesh.vertices.copy(), np.zeros_like(mesh.vertices), np.ones(len(mesh.vertices), bool)
    free[[3, 5]] = False
    advance(springs_of(small_gown, woven), x, v, free, 0.001, 50)
    np.testing.assert_array_equal(x[[3, 5]], mesh.vertices[[3, 5]])
    assert np.abs(x - mesh.vertices).max() > 0.005


def test_without_a_clamp_only_ratios_show(small_gown):
    bigger = replace(
        small_gown,
        **{name: 2.0 * getattr(small_gown, name) for name in ("mass", "elastic", "bending", "damping", "air_drag")},
    )
    here, there = (fall(gown, rest(gown), clamp=0.0) for gown in (small_gown, bigger))
    np.testing.assert_allclose(here, there, atol=1e-6)
    here, there = (fall(gown, rest(gown)) for gown in (small_gown, bigger))
    assert np.abs(here - there).max() > 0.01
