"""A hand's camera looks at a place, upright, from a given distance or place."""

import numpy as np
import pytest
from caretree.sim.robot.baxter import BAXTER
from caretree.skills.control.hand_view import camera_in_hand, level_view, view_of

TARGET = np.array((3.0, 0.2, 1.2))


@pytest.mark.parametrize("hand", ["left", "right"])
@pytest.mark.parametrize("angle", [0.0, 0.9, -2.0])
def test_the_place_is_in_the_middle_of_an_upright_picture(hand, angle):
    heading = np.array((np.cos(angle), np.sin(angle), 0.0))
    camera = level_view(BAXTER, hand, TARGET, heading, 0.6) @ camera_in_hand(BAXTER, hand)
    place = np.linalg.inv(camera) @ np.append(TARGET, 1.0)
    assert place[:3] == pytest.approx((0.0, 0.0, 0.6), abs=1e-9)  # [m]
    assert camera[:3, 1] == pytest.approx((0.0, 0.0, -1.0), abs=1e-9), "the picture's rows go down"
    assert np.linalg.det(camera[:3, :3]) == pytest.approx(1.0)


@pytest.mark.parametrize("hand", ["left", "right"])
def test_from_a_given_place_it_looks_down_at_another_one_which_is_in_the_middle(hand):
    eye = TARGET + (0.4, -0.5, 0.25)
    camera = view_of(BAXTER, hand, TARGET, eye) @ camera_in_hand(BAXTER, hand)
    assert camera[:3, 3] == pytest.approx(eye)
    place = np.linalg.inv(camera) @ np.append(TARGET, 1.0)
    assert place[:3] == pytest.approx((0.0, 0.0, np.linalg.norm(eye - TARGET)), abs=1e-9)
    assert camera[2, 0] == pytest.approx(0.0), "the picture's rows are level"
    assert camera[2, 1] < 0.0, "and go down"
