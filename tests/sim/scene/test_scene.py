"""Scenes are seeded draws."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.scene.gown import GOWNS
from caretree.sim.scene.scene import draw_scene, room_map
from caretree.sim.world_kind import WorldKind


def test_the_same_seed_draws_the_same_scene():
    a, b = draw_scene(4), draw_scene(4)
    assert a.person == b.person
    for draw in ("gown", "bed_xy", "rail_xy", "hang_vertex", "hang_yaw"):
        assert getattr(a, draw) == getattr(b, draw)


def test_seeds_vary_everything():
    scenes = [draw_scene(seed) for seed in range(12)]
    assert {scene.gown.name for scene in scenes} == set(GOWNS)
    for draw in ("hang_vertex", "bed_xy", "rail_xy", "hang_yaw"):
        assert len({getattr(scene, draw) for scene in scenes}) > 3
    assert len({scene.person.pose["left"] for scene in scenes}) == 12
    assert len({scene.person.dry_friction for scene in scenes}) == 12


def test_cloth_slides_harder_on_skin_where_that_is_asked_for_and_nothing_else_changes():
    for seed in range(100, 120):
        easy, hard = draw_scene(seed), draw_scene(seed, kind=WorldKind.named("easy+skin_friction"))
        assert easy.person.skin_friction * easy.gown.friction == pytest.approx(0.2, abs=0.03)
        assert 0.3 <= hard.person.skin_friction * hard.gown.friction <= 0.6
        assert replace(hard.person, skin_friction=easy.person.skin_friction) == easy.person


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"seed": -1}, "negative"),
        ({"seed": 0, "gown": "tutu"}, "medium, large, light"),
        ({"seed": 0, "person": "giant"}, "average, small, stiff"),
    ],
)
def test_wrong_scenes_are_refused_with_what_is_allowed(arguments, says):
    with pytest.raises(CaretreeError, match=says):
        draw_scene(**arguments)


@pytest.mark.parametrize("name", sorted(GOWNS))
def test_gowns_have_the_size_the_design_asks_for(name):
    mesh = draw_scene(0, gown=name).mesh
    assert 600 <= len(mesh.vertices) <= 1500


def test_waypoints_are_where_the_base_may_stand():
    room = room_map()
    for x, y, _ in room.waypoints.values():
        column, row = np.round((np.array((x, y)) - room.origin) / room.resolution).astype(int)
        assert room.free[row, column]
    assert not room.free[int(3.0 / room.resolution), int(3.0 / room.resolution)]  # the middle of the bed
