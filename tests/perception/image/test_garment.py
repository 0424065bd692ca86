"""Labels and side of the gown against what the renderer drew."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.image.garment import gown_labels, gown_side, tapes_show
from caretree.perception.image.surfaces import Surface
from caretree.sim.render.camera import CLOTH_ID, HEAD_SIZE, camera_intrinsics


@pytest.mark.parametrize("seed", range(3))
def test_what_is_labelled_is_the_gown(scenes, seed):
    for scene in (scenes.on_rail(seed), scenes.in_hand(seed), scenes.stretched(seed, outside=seed % 2 == 0)):
        drawn = scene.renderer.render(scene.camera, HEAD_SIZE, camera_intrinsics("head")).ids == CLOTH_ID
        found = gown_labels(scene.frame(seed)) != Surface.OTHER
        assert (drawn & found).sum() / (drawn | found).sum() > 0.93


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("outside", [True, False])
def test_side(scenes, seed, outside):
    side = gown_side(scenes.stretched(seed, outside=outside).frame(seed, stamp=3.0))
    assert side.outside is outside
    assert side.confidence > 0.8
    assert side.stamp == 3.0


def test_a_gown_has_tapes_where_their_colours_show(scenes, black):
    frame = scenes.on_rail(0).frame(0)
    assert tapes_show(frame)
    blue = frame.rgb.copy()
    blue[np.isin(gown_labels(frame), (Surface.ARMHOLE, Surface.CUFF))] = (120, 160, 215)
    assert not tapes_show(replace(frame, rgb=blue))
    assert not tapes_show(black)


def test_no_gown_and_no_depth(scenes, black):
    with pytest.raises(PerceptionFailure) as nothing:
        gown_labels(scenes.person(0).frame())
    assert nothing.value.kind == "nothing_seen"
    with pytest.raises(PerceptionFailure):
        gown_side(black)
    blind = scenes.stretched(0, outside=True).frame()
    with pytest.raises(PerceptionFailure) as no_depth:
        gown_labels(replace(blind, depth=np.zeros_like(blind.depth)))
    assert no_depth.value.problem is Problem.NO_DEPTH
