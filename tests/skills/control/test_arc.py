import numpy as np
import pytest
from caretree.skills.control.arc import Arc

SHOULDER, ELBOW = np.array((0.2, -0.5, 0.7)), np.array((0.4, -0.3, 0.66))
GOAL = np.array((0.6, 0.4, 0.48**0.5))


def test_the_hand_stays_at_the_arm_s_length_and_rises():
    arc = Arc(SHOULDER, ELBOW, GOAL)
    np.testing.assert_allclose(arc.at(0.0)[0], ELBOW, atol=1e-12)
    heights = []
    for raised in np.linspace(0.0, arc.angle, 9):
        point, tangent = arc.at(raised)
        assert np.linalg.norm(point - SHOULDER) == pytest.approx(arc.radius)
        assert tangent @ (point - SHOULDER) == pytest.approx(0.0, abs=1e-12)
        heights.append(point[2])
    assert (np.diff(heights) > 0).all()
    np.testing.assert_allclose(arc.at(arc.angle)[0], SHOULDER + arc.radius * GOAL, atol=1e-12)
    # turning the arm about the axis is the same motion
    turned = np.cross(arc.axis, ELBOW - SHOULDER)
    assert turned @ arc.at(0.0)[1] > 0


def test_weight_along_the_arc_is_borne_and_a_pull_across_it_is_given_way_to():
    arc = Arc(SHOULDER, ELBOW, GOAL)
    tangent = arc.at(0.3)[1]
    np.testing.assert_allclose(arc.give_way(-15.0 * tangent, tangent, 0.0, 0.1), 0.0, atol=1e-12)
    inwards = (SHOULDER - ELBOW) / arc.radius
    inwards -= (inwards @ tangent) * tangent
    velocity = arc.give_way(10.0 * inwards / np.linalg.norm(inwards), tangent, 0.1, 0.1)
    assert velocity @ inwards > 0
    np.testing.assert_allclose(arc.offset, 0.1 * velocity)
    for n in range(1000):
        arc.give_way(100.0 * inwards, tangent, 0.1 * n, 0.1)
    assert np.linalg.norm(arc.offset) <= 0.08 + 1e-9


def test_friction_of_a_joint_is_borne_so_that_an_arm_is_spread():
    arc = Arc(SHOULDER, ELBOW, GOAL)
    tangent = arc.at(0.3)[1]
    np.testing.assert_array_equal(arc.give_way(8.6 * arc.axis, tangent, 0.0, 0.1), 0.0)
    assert arc.give_way(-20.0 * arc.axis, tangent, 0.1, 0.1) @ arc.axis < 0, "whatever pulls harder is given way to"


def test_a_bent_arm_is_straightened_on_the_way():
    bent, straight = np.linalg.norm(ELBOW - SHOULDER), 0.5
    arc = Arc(SHOULDER, ELBOW, GOAL, reach=straight)
    np.testing.assert_allclose(arc.at(0.0)[0], ELBOW, atol=1e-12)
    np.testing.assert_allclose(arc.at(arc.angle)[0], SHOULDER + straight * GOAL, atol=1e-12)
    half = 0.5 * arc.angle
    assert np.linalg.norm(arc.at(half)[0] - SHOULDER) == pytest.approx(0.5 * (bent + straight))
    step = 1e-6
    moved = (arc.at(half + step)[0] - arc.at(half)[0]) / step
    np.testing.assert_allclose(arc.velocity(half, rate=0.3), 0.3 * moved, atol=1e-5)


def test_a_straight_arm_keeps_its_circle():
    arc = Arc(SHOULDER, ELBOW, GOAL)
    np.testing.assert_allclose(arc.velocity(0.2, rate=0.3), 0.3 * arc.radius * arc.at(0.2)[1])
