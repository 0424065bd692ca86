"""Cloth at the fingertips and layers between them."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.gown.layers import gripped_cloth, layers
from caretree.sim.render.camera import looking_at

CENTRE = np.array((0.0, 0.0, 1.2))
HAND = np.eye(4)
HAND[:3, 3] = CENTRE  # closes along y


def sheets(scenes, offsets, seed=0, wide=0.5):
    """A room with square sheets across the closing direction, seen from the side that shows both."""
    scene = scenes.room(seed, looking_at(CENTRE + np.array((0.5, 0.35, 0.25)), CENTRE))
    n = len(offsets)
    square = np.array([(-wide, 0, -wide), (wide, 0, -wide), (wide, 0, wide), (-wide, 0, wide)]) * 0.05
    vertices = np.vstack([square + CENTRE + np.array((0.0, y, 0.0)) for y in offsets]) if n else np.zeros((3, 3))
    faces = np.vstack([np.array(((0, 1, 2), (0, 2, 3))) + 4 * k for k in range(n)]) if n else np.zeros((0, 3), int)
    colour = np.tile(scene.look.colours["gown_outside"], (len(faces), 1))
    scene.renderer.set_cloth(vertices, faces, colour, colour)
    return scene


@pytest.mark.parametrize(("offsets", "expected"), [((), 0), ((0.0,), 1), ((-0.02, 0.02), 2), ((-0.2,), 0)])
def test_sheets_are_counted(scenes, offsets, expected):
    scene = sheets(scenes, offsets)
    if not offsets:
        with pytest.raises(PerceptionFailure):
            layers([scene.frame()], "left", HAND)
        return
    count = layers([scene.frame(2)], "left", HAND)
    assert count.layers == expected
    assert 0 < count.confidence < 1
    assert count.side == "left"


def test_views_of_a_carried_gown_are_put_together(scenes):
    """Seen while the carrying hand turns, the same corner stays one layer where it is now."""
    turned = [scenes.in_hand(0, turn) for turn in (0.0, 0.5, 1.0)]
    corner = turned[-1].vertices[turned[-1].gown.corners[1]]
    hand = np.eye(4)
    hand[:3, 3] = corner
    count = layers([s.frame(k) for k, s in enumerate(turned)], "right", hand, [s.hand for s in turned])
    assert count.layers >= 1


def test_held_or_not(scenes):
    for seed in range(3):
        scene = scenes.in_hand(seed)
        assert gripped_cloth(scene.frame(seed), scene.hand).confidence > 0.6
        scene.renderer.move_cloth(scene.vertices - (0, 0, 0.3))
        assert gripped_cloth(scene.frame(seed), scene.hand).confidence < 0.2


@pytest.mark.parametrize("before", [0.0, 0.15])  # the fingertips, towards the camera [m]
def test_fingertips_behind_other_cloth_cannot_be_told(scenes, before):
    scene = sheets(scenes, [0.0], wide=1.5)
    frame = scene.frame()
    eye = frame.pose_camera_in_map[:3, 3]
    behind = HAND.copy()
    behind[:3, 3] = CENTRE - before * (eye - CENTRE) / np.linalg.norm(eye - CENTRE)
    if before == 0.0:
        assert gripped_cloth(frame, behind).confidence > 0.6
        return
    with pytest.raises(PerceptionFailure) as failure:
        gripped_cloth(frame, behind)
    assert failure.value.problem == Problem.HIDDEN


def test_failures(scenes, black):
    scene = scenes.in_hand(0)
    away = np.eye(4)
    away[:3, 3] = (5, 5, 5)
    with pytest.raises(PerceptionFailure) as out:
        gripped_cloth(scene.frame(), away)
    assert out.value.kind == "out_of_reach"
    with pytest.raises(PerceptionFailure) as nothing:
        layers([black], "left", HAND)
    assert nothing.value.kind == "nothing_seen"
