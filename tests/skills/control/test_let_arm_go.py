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

from ..bench import ARM, beside_bed, pulls
from ..moving import carry_out

STIFFNESS = 700.0  # of an arm against the hand that holds it [N/m]


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


@pytest.mark.parametrize(
    ("push", "gives"), [((-7.0, 14.0, 0.0), True), ((0.0, 3.0, 14.0), True), ((3.0, 2.0, -18.0), False)]
)
def test_a_hand_that_is_pressed_by_the_arm_gives_way_before_it_opens(push, gives):
    on_arm = over_arm(lying_posture("right"), 1.0, lift=0.0)
    world, context = beside_bed(hands={"left": on_arm}, held={"left": ARM}, load={"left": push})()
    start = world.observe().pose_hand_in_map[0, :3, 3]
    seen = []

    def springs_back(skill):
        now = world.observe()
        held = now.gripper_opening[0] < ARM + 0.002
        force = np.array(push) - STIFFNESS * (now.pose_hand_in_map[0, :3, 3] - start)
        pulls(world, "left", held * force)
        if held:
            seen.append(world.observe())

    skill = carry_out(world, context, lambda skill: let_arm_go(skill, "left", "never"), each_tick=springs_back)
    assert skill.failure is None
    last = seen[-1]
    pressed = last.wrench_hand_in_map[0, :3] * (1.0, 1.0, float(push[2] > 0.0))
    assert np.linalg.norm(pressed) < 10.0
    assert bool(np.linalg.norm(last.pose_hand_in_map[0, :3, 3] - start) > 0.005) is gives
