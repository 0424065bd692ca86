"""The camera goes where the hands can be seen."""

from __future__ import annotations

import numpy as np
from caretree.sim.render.camera import Renderer
from caretree.sim.render.raster import Light
from caretree.sim.render.solids import box_mesh
from caretree.sim.render.view_choice import HOLD, ViewChoice, Viewpoint, seen_share

LIGHT = Light(direction_in_map=np.array((0.0, 0.0, 1.0)))
HANDS = np.array(((0.0, -0.2, 1.0), (0.0, 0.2, 1.0)))
FIELD = np.deg2rad(50.0)


def room(*boxes):
    renderer = Renderer(LIGHT)
    for k, (low, high) in enumerate(boxes):
        renderer.add_rigid(f"box{k}", *box_mesh(np.array(low), np.array(high)), (100, 100, 100))
    return renderer.triangles()


WALL = ((0.5, -2.0, 0.0), (0.6, 2.0, 2.7))  # hides the hands from larger x


def test_what_is_behind_something_or_out_of_the_picture_is_not_seen():
    from_east, from_west = (Viewpoint(np.array((x, 0.0, 1.2)), np.array((0.0, 0.0, 1.0))) for x in (2.0, -2.0))
    assert seen_share(room(WALL), LIGHT, from_west, FIELD, HANDS) == 1.0
    assert seen_share(room(WALL), LIGHT, from_east, FIELD, HANDS) == 0.0
    away = Viewpoint(np.array((-2.0, 0.0, 1.2)), np.array((-4.0, 0.0, 1.0)))
    assert seen_share(room(WALL), LIGHT, away, FIELD, HANDS) == 0.0


def test_a_view_is_chosen_that_sees_the_hands_and_is_kept_a_while():
    wall = room(WALL)
    choice = ViewChoice(FIELD, close=True)
    first = choice.at(0.0, wall, LIGHT, HANDS)
    assert first.eye[0] < 0.5
    mirrored = room(((-0.6, -2.0, 0.0), (-0.5, 2.0, 2.7)))
    kept = choice.at(HOLD / 2, mirrored, LIGHT, HANDS)
    np.testing.assert_allclose(kept.eye, first.eye)
    assert choice.at(HOLD + 2.0, mirrored, LIGHT, HANDS).eye[0] > -0.5


def test_a_second_view_shows_another_side():
    first = ViewChoice(FIELD, close=False).at(0.0, room(), LIGHT, HANDS)
    second = ViewChoice(FIELD, close=True).at(0.0, room(), LIGHT, HANDS, first)
    assert first.pose[:3, 2] @ second.pose[:3, 2] < 0.75


def test_the_camera_glides_after_hands_that_move():
    choice = ViewChoice(FIELD, close=True)
    before = choice.at(0.0, room(), LIGHT, HANDS)
    after = choice.at(0.1, room(), LIGHT, HANDS + (0.5, 0.0, 0.0))
    assert 0.0 < after.target[0] - before.target[0] < 0.25
