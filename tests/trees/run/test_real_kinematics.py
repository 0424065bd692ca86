"""The spine on the scripted world with the real robot's kinematics in place of the linear arms."""

import numpy as np
import pytest
from caretree.sim.mechanics.kinematics import Kinematics
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import HandTwist, JointTrajectory
from caretree.trees.guard.guard import GuardedWorld
from caretree.trees.guard.limits import DEFAULT
from caretree.trees.run.runner import run
from caretree.trees.run.task import load_task


@pytest.fixture(scope="module")
def kinematics():
    return Kinematics(BAXTER)


def test_a_task_runs(kinematics):
    world = ScriptedWorld(kinematics=kinematics, arm_positions=model.READY)
    assert run(load_task("wave"), world).outcome == "success"


def test_a_swing_past_the_person_is_slowed_to_the_limit(kinematics):
    world = ScriptedWorld(kinematics=kinematics, arm_positions=model.READY)
    guard = GuardedWorld(world)
    start = world.observe().pose_hand_in_map[0, :3, 3]
    guard.update_person(start + np.array((0.1, 0.2, 0.0)), radius=0.05)
    swing = np.stack((model.READY[0], model.READY[0] + np.array((0.6, 0.3, 0, -0.4, 0, 0, 0))))
    joints = tuple(model.arm_joints("left"))
    sent = guard.send(JointTrajectory(joints=joints, times=np.array((0.0, 1.0)), positions=swing))
    assert sent.times[-1] > 2.0
    fastest = []
    before = start
    while world.clock.now() < sent.times[-1]:
        world.clock.wait_until(world.clock.now() + 0.02)
        hand = world.observe().pose_hand_in_map[0, :3, 3]
        if guard.zone.distance(before)[0] < DEFAULT.near_person:
            fastest.append(np.linalg.norm(hand - before) / 0.02)
        before = hand
    assert 0.1 < max(fastest) <= DEFAULT.hand_speed


def test_a_twist_moves_the_real_hand_straight(kinematics):
    world = ScriptedWorld(kinematics=kinematics, arm_positions=model.READY)
    start = world.observe().pose_hand_in_map[1]
    GuardedWorld(world).send(HandTwist(side="right", twist_in_map=np.array((0, 0, 0.05, 0, 0, 0)), duration=1.0))
    world.clock.wait_until(1.5)
    end = world.observe().pose_hand_in_map[1]
    np.testing.assert_allclose(end[:3, 3] - start[:3, 3], (0, 0, 0.05), atol=2e-3)
    np.testing.assert_allclose(end[:3, :3], start[:3, :3], atol=2e-2)
