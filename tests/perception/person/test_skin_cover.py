import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.person.skin_cover import skin_cover


def hand_of(scene):
    wrist, tip = scene.arms["right"][2:]
    return wrist + np.linspace(0.3, 0.95, 10)[:, None] * (tip - wrist)


def test_a_bare_hand_is_not_covered_and_one_under_something_is(scenes):
    scene = scenes.person(0)
    frame = scene.frame(1, stamp=2.5)
    bare = skin_cover(frame, hand_of(scene))
    assert bare.share < 0.3
    assert bare.stamp == 2.5
    frame.rgb[:] = (60, 110, 180)
    assert skin_cover(frame, hand_of(scene)).share == 1.0


def test_a_hand_out_of_view_is_no_answer(scenes):
    scene = scenes.person(0)
    with pytest.raises(PerceptionFailure):
        skin_cover(scene.frame(1), hand_of(scene) + (0.0, 0.0, 30.0))
