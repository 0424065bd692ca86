import numpy as np
import pytest
from caretree.skills.geometry.stances import HEADWARD, LIFTING, PULLING, STANCES, outwards, stance


@pytest.mark.parametrize("stand", ["lift", "shoulder"])
def test_stances_are_mirrored_and_face_the_bed(stand):
    right, left = stance("right", stand), stance("left", stand)
    np.testing.assert_allclose(left[:2], right[:2] * (-1.0, 1.0))
    for arm, (x, y, yaw) in (("right", right), ("left", left)):
        assert np.array((x, y, 0.0)) @ outwards(arm) > 0.8, "beside the bed, which is 0.9 m wide, on the arm's side"
        assert np.array((np.cos(yaw), np.sin(yaw), 0.0)) @ -outwards(arm) == pytest.approx(1.0)


def test_the_shoulder_is_reached_from_farther_headward():
    for arm in ("right", "left"):
        towards_head = (stance(arm, "shoulder") - stance(arm, "lift"))[:2] @ HEADWARD[:2]
        assert 0.1 < towards_head < 0.5


def test_a_base_that_slides_along_the_bed_looks_headward():
    assert np.cos(STANCES.heading) == pytest.approx(HEADWARD[0], abs=1e-9)
    assert np.sin(STANCES.heading) == pytest.approx(HEADWARD[1])


@pytest.mark.parametrize("arm", ["right", "left"])
def test_one_hand_lifts_and_the_other_pulls(arm):
    assert {LIFTING[arm], PULLING[arm]} == {"left", "right"}
    yaw = stance(arm, "lift")[2]
    left_of_base = np.array((-np.sin(yaw), np.cos(yaw), 0.0))
    assert (left_of_base @ HEADWARD > 0) == (LIFTING[arm] == "left"), "the hand on the head side lifts"
