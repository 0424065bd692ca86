from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import SIDES
from caretree.skills.belief.strap_grasp import presenting_position, way_in
from caretree.skills.geometry.arm_path import ArmPath
from caretree.skills.geometry.stances import PULLING, outwards, stance
from caretree.skills.motion.errors import Unreachable
from caretree.skills.motion.ik import solve_ik
from caretree.skills.scripted.scripted_person import laid_strap, lying_posture

from ..moving import idle, robot


@pytest.mark.parametrize("arm", SIDES)
@pytest.mark.parametrize("worn", [False, True])
def test_the_way_in_is_straight_from_above_and_within_reach(arm, worn):
    base, hand, strap = stance(arm, "lift"), PULLING[arm], laid_strap(arm)
    _, context = robot(base=tuple(base))
    way = way_in(idle(context), arm, hand, strap, ArmPath.of(lying_posture(arm)), worn=worn)
    np.testing.assert_allclose(way.before[:3, :3], way.inside[:3, :3])
    approach = way.inside[:3, 2]
    forwards = way.inside[:3, 3] - way.before[:3, 3]
    assert approach @ forwards == pytest.approx(np.linalg.norm(forwards)), "straight on"
    assert approach[2] < -0.3, "from above"
    assert approach @ outwards(arm) < 0.1, "from the robot's side"
    deeper = way.inside[:3, 3] - strap.position_in_map
    np.testing.assert_allclose(deeper, (deeper @ approach) * approach, atol=1e-9)
    assert 0.0 < deeper @ approach < 0.03
    q = solve_ik(kinematics_of(BAXTER), hand, way.before, base, model.READY[SIDES.index(hand)])
    solve_ik(kinematics_of(BAXTER), hand, way.inside, base, q)


def test_a_strap_out_of_reach_is_told():
    _, context = robot(base=tuple(stance("right", "lift")))
    strap = laid_strap("right")
    far = replace(strap, position_in_map=strap.position_in_map - (1.5, 0.0, 0.0))
    with pytest.raises(Unreachable):
        way_in(idle(context), "right", "right", far, ArmPath.of(lying_posture("right")))


def test_the_sleeve_is_presented_straight_before_the_fingertips():
    path = ArmPath.of(lying_posture("right"))
    position = presenting_position(path, 0.4)
    assert np.linalg.norm(position - path.points[3]) == pytest.approx(0.4)
    assert position[2] == pytest.approx(path.points[3, 2])
