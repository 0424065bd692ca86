"""Fingers meet cloth: they push it, take what is between them, and the same action comes to the same."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.learning.pregrasp.gowns import mesh_of
from caretree.learning.pregrasp.hung_state import HungState, hang
from caretree.learning.pregrasp.numbers import HANG
from caretree.learning.pregrasp.roll_out import roll_out, waypoints
from caretree.learning.seeds import KEPT_SEEDS
from caretree.sim.pregrasp.action import path_to
from caretree.sim.pregrasp.numbers import ACTION, PRIMITIVES, VIEWS
from caretree.sim.robot.hand_boxes import boxes_of

SEED = 104


@pytest.fixture(scope="module")
def state() -> HungState:
    return hang(SEED)


def test_gown_hangs_still_from_one_end_of_its_neckline(state: HungState) -> None:
    mesh = mesh_of(state.gown)
    assert np.linalg.norm(state.vertices[list(state.held)], axis=1).max() < 0.1
    assert (set(mesh.corners) & set(state.held)) == set(mesh.corners) - {state.wanted}
    assert state.vertices[:, 2].max() < 0.1
    assert state.vertices[state.wanted, 2] < -0.6
    assert state.speed < 0.15


def test_same_seed_same_state_and_another_seed_another(state: HungState) -> None:
    assert np.array_equal(hang(SEED).vertices, state.vertices)
    other = hang(SEED + 1, state.gown)
    assert np.abs(other.vertices - state.vertices).max() > 0.05


def test_hand_goes_in_and_aside() -> None:
    place = np.array((0.1, 0.2, -0.8))
    for k, name in enumerate(PRIMITIVES):
        path = path_to(place, 0, k)
        moved = (path.end - path.inside) @ path.turn
        side = {"move_left": -ACTION.sweep, "direct": 0.0, "move_right": ACTION.sweep}[name]
        assert moved == pytest.approx((0.0, side, 0.0), abs=1e-12)
        assert np.linalg.det(path.turn) == pytest.approx(1.0)
        assert (path.inside - place) @ path.turn[:, 2] == pytest.approx(ACTION.depth)
        ways = waypoints(path, HANG.step)
        assert ways[-1] == pytest.approx(path.end)
        assert np.linalg.norm(np.diff(ways, axis=0), axis=1).max() <= ACTION.approach_speed * HANG.step * 1.001


def test_a_sweep_moves_cloth_and_cloth_stays_out_of_the_fingers(state: HungState) -> None:
    spot = state.vertices[state.wanted].astype(float)
    grasp = roll_out(state, path := path_to(spot, 2 * VIEWS.turn, PRIMITIVES.index("move_right")))
    moved = np.linalg.norm(grasp.vertices - state.vertices, axis=1)
    assert 0.01 < moved.max() < 0.15
    for box in boxes_of(path.turn, path.end, ACTION.opening):
        local = np.abs((grasp.vertices - box[:3]) @ path.turn) - box[3:6]
        assert local.max(axis=1).min() > -0.003  # no vertex is inside of a box


def test_the_same_action_comes_to_the_same_whatever_was_done_before(state: HungState) -> None:
    spot = state.vertices[state.wanted].astype(float)
    first = roll_out(state, path_to(spot, 1 * VIEWS.turn, 1))
    roll_out(hang(SEED + 1, state.gown), path_to(spot, 3 * VIEWS.turn, 0))
    again = roll_out(state, path_to(spot, 1 * VIEWS.turn, 1))
    assert np.array_equal(first.vertices, again.vertices)
    assert (first.layers, first.corner) == (again.layers, again.corner)


def test_a_grasp_far_from_the_gown_takes_nothing(state: HungState) -> None:
    grasp = roll_out(state, path_to(np.array((1.0, 1.0, -0.8)), 0, 1))
    assert grasp.layers == 0
    assert not grasp.corner
    assert not grasp.success


def test_kept_seeds_are_those_from_9000_on() -> None:
    assert KEPT_SEEDS == 9000


def test_a_deep_grasp_holds_the_middle_of_the_neckline_and_repeats() -> None:
    deep = hang(SEED, deep=True)
    mesh = mesh_of(deep.gown)
    held = [int(k) for k in mesh.collar if k in deep.held]
    assert held
    assert not set(mesh.corners) & set(deep.held)
    assert deep.deep
    assert deep.wanted in mesh.corners
    assert np.array_equal(hang(SEED, deep=True).vertices, deep.vertices)
    path = path_to(deep.vertices[deep.wanted].astype(float), 1 * VIEWS.turn, 1)
    first = roll_out(deep, path)
    roll_out(deep, path_to(deep.vertices[deep.wanted].astype(float), 4 * VIEWS.turn, 2))
    assert np.array_equal(roll_out(deep, path).vertices, first.vertices)
