"""A cloth of springs against laws it must keep: energy, weight, friction, what it must not pass through."""

import numpy as np
import pytest
from caretree.sim.bullet.soft_world import GRAVITY, MARGIN
from caretree.sim.spring.sheet import LONGEST, Sheet
from caretree.sim.spring.solids import Solids

from .conftest import DT, block, log


def run(sheet, solids, seconds):
    """Pass time; returns what the cloth gave to each solid in all."""
    given = np.zeros((len(solids.friction), 7))
    for _ in range(round(seconds / DT)):
        solids.read(DT)
        sheet.step(solids, given)
    return given


def stretch(sheet):
    a, b = sheet.mesh.faces[:, :2].T
    rest = sheet.mesh.vertices
    return np.linalg.norm(sheet.x[a] - sheet.x[b], axis=1) / np.linalg.norm(rest[a] - rest[b], axis=1)


def test_energy_does_not_grow_in_the_air_or_on_a_body(client, towel):
    block(client, (2, 2, 0.1), (0, 0, 0))
    log(client, 0.05, 1.0, (0, 0, 0.15))
    solids = Solids(client, 1.0)
    sheet = Sheet(towel, towel.vertices + (0, 0, 0.3), DT)
    sheet.v[:] = np.random.default_rng(3).normal(0.0, 0.3, sheet.v.shape)
    before = [sheet.energy()]
    for _ in range(40):
        run(sheet, solids, 0.05)
        before.append(sheet.energy())
    assert (np.diff(before) < 1e-3 * before[0]).all(), "more than rounding and what comes out of a body [J]"
    assert before[-1] < 0.8 * before[0], "it has come to rest"


def test_a_free_fall_is_one(client, towel):
    sheet = Sheet(towel, towel.vertices, DT)
    run(sheet, Solids(client, 1.0), 0.5)
    np.testing.assert_allclose(sheet.v.mean(axis=0), (0, 0, -0.5 * GRAVITY), atol=1e-9)


def test_what_it_lies_on_carries_its_weight(client, towel):
    block(client, (2, 2, 0.1), (0, 0, 0))
    log(client, 0.05, 1.0, (0, 0, 0.10))
    solids = Solids(client, 1.0)
    sheet = Sheet(towel, towel.vertices + (0, 0, 0.17), DT)
    run(sheet, solids, 3.0)
    force = run(sheet, solids, 1.0)[:, :3]
    assert force[:, 2].sum() == pytest.approx(-towel.spec.mass * GRAVITY, rel=0.02)
    assert (force[:, 2] < -0.1).all(), "both carry some of it"


def test_what_hangs_pulls_with_its_weight(client, towel):
    sheet = Sheet(towel, towel.vertices, DT)
    sheet.hold([0, 1, 2])
    solids = Solids(client, 1.0)
    run(sheet, solids, 12.0)
    loads = []
    for _ in range(200):
        run(sheet, solids, 0.01)
        loads.append(sheet.load[[0, 1, 2]].sum(axis=0))
    mean = np.mean(loads, axis=0)
    assert mean[2] == pytest.approx(-towel.spec.mass * GRAVITY, rel=0.02)
    assert np.abs(mean[:2]).max() < 0.05 * towel.spec.mass * GRAVITY


@pytest.mark.parametrize(("slope", "slides"), [(0.35, False), (0.5, True)])  # 0.4 is the tangent of the cone
def test_friction_holds_below_the_cone_and_slides_above_it(client, towel, slope, slides):
    block(client, (9, 2, 0.1), (0, 0, -0.05))  # 0.5 of the block times 0.8 of the towel
    sheet = Sheet(towel, towel.vertices + (0, 0, MARGIN), DT)
    angle = np.arctan(slope)
    sheet.gravity = GRAVITY * np.array((np.sin(angle), 0.0, -np.cos(angle)))
    run(sheet, Solids(client, 1.0), 1.0)
    way = sheet.x.mean(axis=0)[0]
    free = 0.5 * GRAVITY * (np.sin(angle) - 0.4 * np.cos(angle))
    assert way == pytest.approx(free, rel=0.05) if slides else abs(way) < 1e-3


def test_a_body_that_moves_takes_it_along(client, towel):
    body = log(client, 0.1, 1.0, (0, 0, 0), mass=1.0, friction=1.0)
    solids = Solids(client, 1.0)
    sheet = Sheet(towel, towel.vertices + (0, 0, 0.1 + MARGIN), DT)
    place, turn = np.zeros(3), client.getQuaternionFromEuler([np.pi / 2, 0.0, 0.0])
    for _ in range(400):  # 0.1 m/s along its axis
        place += (0, 0.1 * DT, 0)
        client.resetBasePositionAndOrientation(body, place.tolist(), turn)
        run(sheet, solids, DT)
    assert sheet.x.mean(axis=0)[1] == pytest.approx(0.1, rel=0.1)
    assert np.abs(sheet.v.mean(axis=0) - (0, 0.1, 0)).max() < 0.02


@pytest.mark.parametrize("radius", [0.027, 0.036, 0.1])  # of a hand, an upper arm, a chest
def test_nothing_falls_through_or_into_a_body(client, towel, radius):
    log(client, radius, 0.6, (0.01, 0, 0))
    sheet = Sheet(towel, towel.vertices + (0, 0, 0.4), DT)
    solids = Solids(client, 1.0)
    run(sheet, solids, 0.5)
    for _ in range(20):
        run(sheet, solids, 0.05)
        for corners in (np.eye(3), np.full((1, 3), 1 / 3), (np.eye(3) + np.roll(np.eye(3), 1, 0)) / 2):
            points = np.einsum("sk,fkd->fsd", corners, sheet.x[towel.faces]).reshape(-1, 3)
            near = np.abs(points[:, 1]) < 0.3
            assert np.hypot(points[near, 0] - 0.01, points[near, 2]).min() > radius - 1e-3
    assert sheet.x[:, 2].max() > 0, "it hangs over the log"


def test_no_edge_is_stretched_farther_than_it_may_be(client, towel):
    sheet = Sheet(towel, towel.vertices, DT)
    sheet.hold([0])
    sheet.gravity *= 4.0  # its own weight does not reach the limit
    run(sheet, Solids(client, 1.0), 2.0)
    assert 0.97 * LONGEST < stretch(sheet).max() < 1.03 * LONGEST
    run(sheet, Solids(client, 1.0), 1.0)
    assert stretch(sheet).max() < 1.03 * LONGEST


def test_a_bed_can_be_left_over_its_edge(client, towel):
    block(client, (1, 1, 0.12), (0, 0, 0))
    sheet = Sheet(towel, towel.vertices + (0.35, 0, 0.06 + MARGIN), DT)
    held = np.flatnonzero(towel.vertices[:, 0] > 0.19)
    sheet.hold(held)
    solids, given = Solids(client, 1.0), np.zeros((1, 7))
    for k in range(1600):  # drawn off and down at 0.15 m/s, as a hand would
        sheet.take(held, sheet.x[held] + np.array((0.12, 0.0, -0.09 if k < 800 else 0.0)) * DT)
        sheet.step(solids, given)
    assert sheet.x[:, 0].min() > 0.5, "nothing of it caught at the edge"
    assert np.linalg.norm(sheet.load[held].sum(axis=0)) < 1.5 * towel.spec.mass * GRAVITY


def test_the_same_gives_the_same_bytes(client, towel):
    log(client, 0.05, 1.0, (0, 0, -0.2))
    after = []
    for _ in range(2):
        sheet = Sheet(towel, towel.vertices, DT)
        run(sheet, Solids(client, 1.0), 0.6)
        after.append(sheet.x.tobytes())
    assert after[0] == after[1]


def test_air_slows_it(client, towel):
    from dataclasses import replace

    thick = replace(towel, spec=replace(towel.spec, air_drag=5.0))
    sheet = Sheet(thick, thick.vertices, DT)
    run(sheet, Solids(client, 1.0), 4.0)
    drag = 5.0 * (sheet.springs.area * np.linalg.norm(sheet.v, axis=1) * -sheet.v[:, 2]).sum()
    assert drag == pytest.approx(towel.spec.mass * GRAVITY, rel=0.03)
