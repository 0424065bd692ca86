"""Open hands are drawn back against the way they point, or straight up."""

import numpy as np
import pytest
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld, scripted_room
from caretree.skills.control.withdraw import WithdrawTuning, withdraw
from caretree.skills.core.context import Context
from caretree.skills.core.skill import Skill
from caretree.trees.guard.guard import GuardedWorld


class Mover(Skill):
    def steps(self):
        yield from withdraw(self, ["right"], 0.06, WithdrawTuning(min_rise=self.min_rise))


def way(min_rise):
    """The way back (3,) of the right hand [m], and the unit vector against which it pointed."""
    world = ScriptedWorld(seed=1, room=scripted_room(), kinematics=kinematics_of(BAXTER), arm_positions=model.READY)
    guard = GuardedWorld(world)
    context = Context(world=guard, guard=guard, seed=1)
    skill = Mover("draw back", context)
    skill.min_rise = min_rise
    before = world.observe().pose_hand_in_map[1]
    for _ in range(60):
        context.lease.advance()
        skill.tick_once()
        world.clock.wait_until(world.clock.now() + 1 / 15)
        if skill.status != skill.status.RUNNING:
            break
    return world.observe().pose_hand_in_map[1, :3, 3] - before[:3, 3], -before[:3, 2]


def test_a_hand_that_points_down_goes_back_the_way_it_came():
    moved, back = way(min_rise=-1.0)
    np.testing.assert_allclose(moved, 0.06 * back, atol=0.02)


def test_a_hand_whose_way_back_does_not_rise_goes_straight_up():
    moved, _ = way(min_rise=1.0)
    assert moved[2] == pytest.approx(0.07, abs=0.02)
    assert np.linalg.norm(moved[:2]) < 0.01
