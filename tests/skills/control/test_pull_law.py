import numpy as np
import pytest
from caretree.skills.control.pull_law import PullLaw
from caretree.skills.geometry.arm_path import ArmPath
from caretree.skills.scripted.scripted_person import lying_posture

PATH, LAW = ArmPath.of(lying_posture("right")), PullLaw()


def above(place, aside=0.0):
    across, _, off = PATH.frame(place).T
    return PATH.point(place) + aside * across + 0.09 * off


def test_an_easy_sleeve_is_led_towards_the_shoulder_at_the_wanted_speed():
    for place in (3.3, 2.5, 1.5, 0.5):
        velocity = LAW.velocity(PATH, place, above(place), 0.0, 0.1, np.zeros(3))
        assert np.linalg.norm(velocity) == pytest.approx(0.1, rel=0.05)
        assert velocity @ PATH.direction(place) < -0.09


def test_force_comes_first():
    place, drag = 1.5, PATH.direction(1.5)
    speeds = [-(LAW.velocity(PATH, place, above(place), 0.0, 0.1, load * drag) @ drag) for load in (3, 8, 12, 15, 20)]
    assert speeds[0] == pytest.approx(0.1, rel=0.05)
    assert (np.diff(speeds) < 0).all()
    assert speeds[-1] < 0, "the hand goes back the way it is pulled"


def test_the_hand_comes_back_to_the_path_and_keeps_the_wanted_offset():
    place = 1.5
    across = PATH.frame(place)[:, 0]
    assert LAW.velocity(PATH, place, above(place, 0.05), 0.0, 0.1, np.zeros(3)) @ across < -0.02
    assert abs(LAW.velocity(PATH, place, above(place, 0.05), 0.05, 0.1, np.zeros(3)) @ across) < 0.01


def test_turning_is_bounded_and_towards_the_wanted_pose():
    turned = np.eye(4)
    turned[:3, :3] = ((0, -1, 0), (1, 0, 0), (0, 0, 1))
    rate = LAW.turn(turned, np.eye(4))
    assert np.linalg.norm(rate) == pytest.approx(0.6)
    assert rate[2] > 0
    np.testing.assert_allclose(LAW.turn(np.eye(4), np.eye(4)), 0.0, atol=1e-12)
