"""Pictures: drawn by seed, and nothing that is held out among those for training."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.vision import pictures
from caretree.learning.vision.labels import OTHER
from caretree.learning.vision.pictures import _room as room
from caretree.learning.vision.pictures import chosen_states, draw_picture
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.baxter import BAXTER

from .still_room import still_state


@pytest.fixture(scope="module")
def states():
    return [still_state("hung"), still_state("laid"), still_state("hung", seed=114)]


def test_same_seed_same_bytes(states):
    one, other = (draw_picture(states, "train", 7, 3) for _ in range(2))
    assert one.frame.rgb.tobytes() == other.frame.rgb.tobytes()
    assert one.frame.depth.tobytes() == other.frame.depth.tobytes()
    assert one.labels.surface.tobytes() == other.labels.surface.tobytes()
    assert draw_picture(states, "train", 7, 4).frame.rgb.tobytes() != one.frame.rgb.tobytes()


def test_what_is_asked_for_is_drawn(states):
    picture = draw_picture(states, "train", 7, 0, look="taped", kind="laid", camera="head")
    assert (picture.look, picture.state.kind, picture.frame.camera) == ("taped", "laid", "head")
    assert picture.frame.rgb.shape == (300, 400, 3)
    assert draw_picture(states, "train", 7, 0, camera="left_hand").frame.rgb.shape == (240, 320, 3)


def test_a_picture_shows_what_its_labels_say(states):
    shares = []
    for number in range(6):
        picture = draw_picture(states, "train", 1, number, look="plain", kind="hung", camera="left_hand")
        shares.append((picture.labels.surface != OTHER).mean())
        assert (picture.frame.depth[picture.labels.surface != OTHER] > 0).mean() > 0.5
    assert np.mean(shares) > 0.1


def test_the_robot_s_own_arms_show_in_some_of_the_head_s_pictures_for_training(states, monkeypatch):
    drawn = []
    monkeypatch.setattr(pictures, "_room", lambda *given, own=None, **more: drawn.append(own) or room(*given, **more))
    for number in range(8):
        draw_picture(states, "train", 1, number, kind="hung", camera="head")
    assert 0 < sum(own is not None for own in drawn) < len(drawn)
    base, postures, *_ = next(own for own in drawn if own is not None)
    assert (base.shape, postures.shape) == ((3,), (2, 7))
    drawn.clear()
    draw_picture(states, "train", 1, 0, kind="hung", camera="left_hand")
    draw_picture(states, "test", 1, 0, kind="hung", camera="head")
    assert not any(own is not None for own in drawn)


def test_a_recorded_robot_s_own_cameras_take_most_pictures_for_training_where_they_see_the_gown(states):
    scene, base = states[0].scene, np.array((*states[0].scene.rail_xy, 0.0)) - (0.9, 0.0, 0.0)
    posture = np.concatenate((base, BAXTER.ready.ravel(), (0.0, 0.05, 0.05)))
    seen = [replace(states[0], posture=posture)]
    eye = kinematics_of(BAXTER).pose_camera_in_map("head", base, BAXTER.ready, 0.0)

    def own(states, part):
        poses = [
            draw_picture(states, part, 1, number, kind="hung", camera="head").frame.pose_camera_in_map
            for number in range(8)
        ]
        return sum(np.linalg.norm(pose[:3, 3] - eye[:3, 3]) < 0.1 for pose in poses)

    assert own(seen, "train") >= 4
    away = np.concatenate((base + (0.0, 0.0, np.pi), posture[3:]))
    assert own([replace(states[0], posture=away)], "train") < 2, f"looks away from the gown of seed {scene.seed}"
    assert own([replace(states[0], posture=None)], "train") < 2


def test_every_fifth_seed_is_for_tests(states):
    assert [s.seed for s in chosen_states(states, "test")] == [114]
    assert {s.seed for s in chosen_states(states, "train")} == {110}
    assert chosen_states(states, "heldout") == []
