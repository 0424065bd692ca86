import numpy as np
import pytest
from caretree.skills.geometry.arm_path import ArmPath
from caretree.skills.geometry.strap_grip import presenting, strap_grip
from caretree.skills.motion.ik import hand_pose
from caretree.skills.scripted.scripted_person import laid_strap, lying_posture


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("turned", [1.0, -1.0])
@pytest.mark.parametrize("tilt", [0.0, 0.6])
def test_the_strap_comes_to_lie_across_the_arm_however_it_was_taken(side, turned, tilt):
    strap = laid_strap(side)
    approach = np.array((np.sin(tilt) * (-1.0 if side == "right" else 1.0), 0.0, -np.cos(tilt)))
    taken = hand_pose(strap.position_in_map, approach, turned * strap.closing_in_map)
    grip = strap_grip(side, side, strap, taken)
    along = ArmPath.of(lying_posture(side)).direction(2.5)
    for lean in (0.0, 0.3):
        pose = presenting(grip, along, np.array((0.6, 0.2, 1.0)), lean=lean)
        np.testing.assert_allclose(pose[:3, :3].T @ pose[:3, :3], np.eye(3), atol=1e-9)
        assert np.linalg.det(pose[:3, :3]) == pytest.approx(1.0)
        across = pose[:3, :3] @ grip.across_in_hand
        heading = along * (1, 1, 0) / np.linalg.norm(along[:2])
        assert across @ -heading == pytest.approx(np.cos(lean), abs=1e-9), "the upper edge points to the shoulder"
        assert pose[2, 2] == pytest.approx(-np.cos(lean), abs=1e-9), "the hand comes from above"
        assert pose[:3, 2] @ heading <= 1e-9, "and leans away from the person"
