"""What of the skin is taken for one arm."""

import cv2
import numpy as np
import pytest
from caretree.perception.person.lying_body import body_seen
from caretree.perception.person.skin_view import SkinViewTuning, skin_view


@pytest.mark.parametrize(("side", "sign"), [("left", -1.0), ("right", 1.0)])
def test_it_is_the_skin_beside_the_trunk(scenes, bed, side, sign):
    scene = scenes.person(0)
    frame = scene.frame(0)
    body = body_seen(frame, bed)
    view = skin_view(frame, bed, body, side)
    assert 40 < len(view.points) <= 350
    assert (sign * (view.points[:, 0] - body.middle) > 0.15).all()
    arm = scene.arms[side]
    samples = np.concatenate([np.linspace(arm[k], arm[k + 1], 12) for k in range(3)])
    away = np.linalg.norm(view.points[:, None] - samples, axis=2).min(axis=1)
    assert np.percentile(away, 95) < 0.06
    assert view.trunk is not None
    assert view.trunk.sign == sign


def test_points_are_thinned(scenes, bed):
    frame = scenes.person(0).frame(0)
    view = skin_view(frame, bed, body_seen(frame, bed), "right", SkinViewTuning(max_points=50))
    assert len(view.points) == 50


def test_distances_to_skin_grow_away_from_it(scenes, bed, black):
    frame = scenes.person(0).frame(0)
    body = body_seen(frame, bed)
    view = skin_view(frame, bed, body, "right")
    assert view.to_skin.min() == 0.0
    row, column = np.unravel_index(int(view.to_skin.argmax()), view.to_skin.shape)
    assert view.to_skin[row, column] > 10.0
    nothing = skin_view(black, bed, body, "right")
    assert len(nothing.points) == 0
    assert (nothing.to_skin > 100.0).all()
    assert not nothing.gradient.any()


def test_the_processor_makes_no_difference(scenes, bed):
    frame = scenes.person(0).frame(0)
    body = body_seen(frame, bed)
    usual = skin_view(frame, bed, body, "right")
    cv2.setUseOptimized(False)
    try:
        plain = skin_view(frame, bed, body, "right")
    finally:
        cv2.setUseOptimized(True)
    assert np.array_equal(usual.to_skin, plain.to_skin)
    assert np.array_equal(usual.gradient, plain.gradient)


def test_opencv_is_left_as_it_was(scenes, bed):
    frame = scenes.person(0).frame(0)
    skin_view(frame, bed, body_seen(frame, bed), "right")
    assert cv2.useOptimized()
