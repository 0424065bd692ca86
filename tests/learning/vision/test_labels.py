"""Labels agree with what was put into the room."""

import numpy as np
import pytest
from caretree.learning.vision.labels import (
    ABSENT,
    HIDDEN,
    INSIDE,
    KEY_POINTS,
    OUTSIDE,
    SHOWN,
    SKIN,
    SURFACES,
    key_points,
    label,
    strap_weights,
)
from caretree.learning.vision.pictures import _room
from caretree.sim.render.camera import CAMERA_VIEWS, camera_intrinsics, looking_at
from caretree.sim.render.looks import draw_look

from .still_room import still_state

SIZE, LENS = CAMERA_VIEWS["head"][0], camera_intrinsics("head")


@pytest.fixture
def hung():
    return still_state("hung")


@pytest.fixture
def laid():
    return still_state("laid")


def look_at(state, eye, target, *, gown=True):
    room = _room(state, draw_look("plain", np.random.default_rng(0)), robot=False, gown=gown)
    pose = looking_at(np.array(eye), np.array(target))
    hook = np.array((*state.scene.rail_xy, 1.55))
    return label(room.renderer, state.scene.mesh, state.arms, hook, pose, LENS, SIZE, gown=gown), pose


def before_rail(state, side):
    x, y = state.scene.rail_xy
    return look_at(state, (x, y + side * 1.2, 1.2), (x, y, 1.1))


def test_the_strap_lies_halfway_between_armhole_and_edge(hung):
    mesh = hung.scene.mesh
    middle = strap_weights(mesh, "right") @ mesh.vertices
    rim = mesh.vertices[mesh.loops["armhole_right"]]
    assert np.isclose(middle[0], (rim[:, 0].min() + rim[:, 0].max()) / 2)
    assert np.isclose(middle[2], rim[:, 2].max() / 2)
    assert np.isclose(middle[1], 0.0)


def test_either_side_of_the_gown_is_told(hung):
    before, behind = before_rail(hung, -1)[0], before_rail(hung, 1)[0]
    assert (before.surface == OUTSIDE).sum() > 10 * (before.surface == INSIDE).sum() > 0
    assert (behind.surface == INSIDE).sum() > 10 * (behind.surface == OUTSIDE).sum()
    assert {SURFACES[k] for k in np.unique(before.surface)} >= {"collar", "cuff", "armhole"}


def test_places_on_the_sheet_bring_every_pixel_back_to_the_rest_shape(hung):
    labels, _ = before_rail(hung, -1)
    assert np.isfinite(labels.sheet[labels.surface == OUTSIDE]).all()
    assert np.isnan(labels.sheet[labels.surface == SKIN]).all()
    k = KEY_POINTS.index("corner_left")
    u, v = np.round(labels.points[k, :2]).astype(int)
    corner = hung.scene.mesh.vertices[hung.scene.mesh.corners[0]]
    assert np.linalg.norm(labels.sheet[v + 2, u] - corner) < 0.06


def test_key_points_are_where_the_state_has_them(hung):
    mesh = hung.scene.mesh
    there = dict(zip(KEY_POINTS, key_points(mesh, hung.vertices, hung.arms, np.zeros(3)), strict=True))
    assert np.allclose(there["corner_right"], hung.vertices[mesh.corners[1]])
    assert np.allclose(there["wrist_left"], hung.arms[0, 2])
    assert len(KEY_POINTS) == 17


def test_a_key_point_is_shown_hidden_or_absent(hung):
    labels, pose = before_rail(hung, -1)
    seen = dict(zip(KEY_POINTS, labels.seen, strict=True))
    assert seen["corner_left"] == seen["corner_right"] == SHOWN
    assert seen["wrist_left"] == ABSENT  # the bed is elsewhere
    k = KEY_POINTS.index("corner_left")
    local = (labels.points_in_map[k] - pose[:3, 3]) @ pose[:3, :3]
    assert np.isclose(labels.points[k, 2], local[2], atol=1e-5)


def test_cloth_hides_the_arm_below_it(laid):
    covering = laid.vertices.copy()
    covering[:, 1] -= 0.4
    object.__setattr__(laid, "vertices", covering)
    seen = dict(zip(KEY_POINTS, look_at(laid, (0.2, -0.3, 2.0), (0.2, -0.3, 0.6))[0].seen, strict=True))
    assert seen["elbow_right"] == HIDDEN
    seen = dict(zip(KEY_POINTS, look_at(laid, (0.2, -0.3, 2.0), (0.2, -0.3, 0.6), gown=False)[0].seen, strict=True))
    assert seen["elbow_right"] == SHOWN


def test_without_a_gown_nothing_of_it_is_labelled(laid):
    labels, _ = look_at(laid, (0.2, -0.3, 2.0), (0.2, -0.3, 0.6), gown=False)
    assert set(np.unique(labels.surface)) == {0, SKIN}
    assert np.isnan(labels.sheet).all()
    assert (labels.seen[:9] == ABSENT).all()
