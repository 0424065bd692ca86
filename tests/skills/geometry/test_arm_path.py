import numpy as np
import pytest
from caretree.skills.geometry.arm_path import ArmPath
from caretree.skills.scripted.scripted_person import lying_posture

BENT = ArmPath(np.array(((0.0, 0.0, 0.7), (0.3, 0.0, 0.7), (0.3, 0.25, 0.7), (0.3, 0.4, 0.8))))


def test_places_are_the_joints_and_go_on_past_both_ends():
    for place in range(4):
        np.testing.assert_allclose(BENT.point(place), BENT.points[place], atol=1e-12)
    np.testing.assert_allclose(BENT.point(0.5), (0.15, 0.0, 0.7))
    np.testing.assert_allclose(BENT.point(-0.5), (-0.15, 0.0, 0.7))
    beyond = BENT.point(4.0) - BENT.points[3]
    np.testing.assert_allclose(beyond, BENT.points[3] - BENT.points[2], atol=1e-12)
    places = np.linspace(-0.6, 4.6, 53)
    np.testing.assert_array_equal(BENT.at(places), [BENT.point(place) for place in places.tolist()])


def test_directions_turn_evenly_at_a_joint_and_frames_are_right_handed():
    before, at, after = BENT.direction(0.99), BENT.direction(1.0), BENT.direction(1.01)
    assert before @ at > 0.999
    assert at @ after > 0.999
    assert at @ np.array((1.0, 1.0, 0.0)) / np.sqrt(2) == pytest.approx(1.0, abs=1e-3)
    for place in (-0.2, 0.5, 1.5, 2.5, 3.5):
        frame = BENT.frame(place)
        np.testing.assert_allclose(frame.T @ frame, np.eye(3), atol=1e-9)
        assert np.linalg.det(frame) == pytest.approx(1.0)
        assert frame[2, 0] == pytest.approx(0.0, abs=1e-9), "across the arm is horizontal"
        assert frame[2, 2] > 0.0, "off the arm is upwards"


def test_a_vertical_arm_still_has_a_frame():
    frame = ArmPath(np.array(((0.0, 0.0, 0.7), (0.0, 0.3, 0.7), (0.0, 0.3, 1.0), (0.0, 0.3, 1.2)))).frame(2.5)
    assert np.isfinite(frame).all()
    assert np.linalg.det(frame) == pytest.approx(1.0)


def test_moving_along_and_measuring_agree():
    for start in (3.4, 2.2, 1.0, 0.3):
        for distance in (0.05, 0.3, -0.05, -0.4):
            place = BENT.moved(start, distance)
            assert np.sign(place - start) == np.sign(distance)
            assert BENT.distance(start, place) == pytest.approx(abs(distance), abs=1e-9)


def test_the_nearest_place_is_found_near_a_guess():
    path = ArmPath.of(lying_posture("right"))
    for place in (-0.3, 0.4, 1.5, 2.5, 3.4):
        above = path.point(place) + 0.09 * path.frame(place)[:, 2]
        assert path.coordinate_of(above) == pytest.approx(place, abs=0.03)
        assert path.coordinate_of(above, near=place + 0.3) == pytest.approx(place, abs=0.03)


def test_pitch_is_that_of_the_whole_arm():
    rising = ArmPath(np.array(((0.0, 0.0, 0.0), (1.0, 0.0, 1.0), (2.0, 0.0, 2.0), (3.0, 0.0, 3.0))))
    assert rising.pitch == pytest.approx(np.pi / 4)
