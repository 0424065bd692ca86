"""A hand opens before it goes up, and only then goes where it is ready."""

import numpy as np
import pytest
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.skills.control.arm_grip import over_arm
from caretree.skills.control.let_arm_go import let_arm_go
from caretree.skills.geometry.stances import stance
from caretree.skills.scripted.scripted_person import lying_posture

from ..bench import ARM, beside_bed
from ..moving import carry_out


@pytest.mark.parametrize("ready", ["never", "if possible", "always"])
def test_it_opens_goes_up_and_is_ready_if_asked_to(ready):
    on_arm = over_arm(lying_posture("right"), 1.0, lift=0.0)
    world, context = beside_bed(hands={"left": on_arm}, held={"left": ARM})()
    seen = []
    skill = carry_out(
        world,
        context,
        lambda skill: let_arm_go(skill, "left", ready),
        each_tick=lambda skill: seen.append(skill.world.observe()),
    )
    assert skill.failure is None
    opening = np.array([each.gripper_opening[0] for each in seen])
    way = np.array([each.pose_hand_in_map[0, :3, 3] for each in seen])
    opened = int(np.argmax(opening > 0.08))
    assert np.linalg.norm(way[:opened] - way[0], axis=1).max() < 0.005
    assert way[:, 2].max() - way[0, 2] > 0.15
    there = kinematics_of(BAXTER).pose_hand_in_map("left", model.READY[0], stance("right", "lift"))[:3, 3]
    assert bool(np.linalg.norm(way[-1] - there) < 0.03) is (ready != "never")
