"""An arm is found wherever it lies, and none where there is none."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.person.arm_fit import Limb
from caretree.perception.person.arm_search import ArmSearchTuning, find_arm
from caretree.perception.person.lying_body import body_seen
from caretree.perception.person.skin_view import skin_view


def seen(scene, bed, side, seed=0):
    frame = scene.frame(seed)
    body = body_seen(frame, bed)
    return skin_view(frame, bed, body, side), body


@pytest.mark.parametrize("lift", [0.0, 0.5])
@pytest.mark.parametrize("side", ["left", "right"])
def test_found_at_rest_and_raised(scenes, bed, side, lift):
    scene = scenes.person(1, lift=lift)
    fit = find_arm(*seen(scene, bed, side), side)
    assert np.linalg.norm(fit.joints - scene.arms[side], axis=1).max() < 0.06


def test_a_limb_that_is_known_keeps_its_lengths(scenes, bed):
    scene = scenes.person(1)
    lengths = np.linalg.norm(np.diff(scene.arms["right"], axis=0), axis=1)
    fit = find_arm(*seen(scene, bed, "right"), "right", limb=Limb(lengths=lengths, variation=0.005))
    np.testing.assert_allclose(np.linalg.norm(np.diff(fit.joints, axis=0), axis=1), lengths, rtol=0.03)


def test_skin_that_is_no_arm_is_refused(scenes, bed):
    view, body = seen(scenes.person(0), bed, "right")
    for tuning in (ArmSearchTuning(min_points=len(view.points) + 1), ArmSearchTuning(max_shoulder_offset=1e-6)):
        with pytest.raises(PerceptionFailure) as failure:
            find_arm(view, body, "right", tuning=tuning)
        assert failure.value.problem is Problem.NOTHING_SEEN
