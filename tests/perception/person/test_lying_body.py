"""The body that the head stands for."""

import numpy as np
import pytest
from caretree.perception.person.lying_body import LyingBody, body_seen

BODY = LyingBody(mattress=0.6, middle=0.1, shoulder_y=-0.5, scale=1.0)


@pytest.mark.parametrize("seed", range(4))
def test_shoulders_are_where_they_are(scenes, bed, seed):
    scene = scenes.person(seed)
    body = body_seen(scene.frame(seed), bed)
    for side in ("left", "right"):
        assert np.linalg.norm(body.shoulder_in_map(side) - scene.arms[side][0]) < 0.08


def test_a_given_size_is_not_judged(scenes, bed):
    frame = scenes.person(0).frame(0)
    assert body_seen(frame, bed, 1.1).scale == 1.1
    assert 0.85 <= body_seen(frame, bed).scale <= 1.15


def test_the_right_shoulder_is_the_mirror_of_the_left_one():
    left, right = BODY.shoulder_in_map("left"), BODY.shoulder_in_map("right")
    np.testing.assert_allclose(left[1:], right[1:])
    assert (left[0] + right[0]) / 2 == pytest.approx(BODY.middle)
    assert right[0] > left[0]


def test_each_flank_keeps_its_own_arm_out():
    inside, beside, above = (0.25, -0.2, 0.65), (0.40, -0.2, 0.65), (0.25, -0.2, 1.0)
    depth = BODY.trunk("right", 1.0).depth_inside(np.array((inside, beside, above)))
    assert depth[0] == pytest.approx(0.05)
    assert depth[1] == depth[2] == 0.0
    assert BODY.trunk("left", 1.0).depth_inside(np.array((inside,)))[0] > depth[0]
