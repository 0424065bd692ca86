"""On the simulated person: an arm that is up is put down, and one that was lifted is lowered, gently, until it lies."""

import numpy as np
import pytest
from caretree.perception.classical import ClassicalSenses
from caretree.sim.bullet.gown_placement import RAISED
from caretree.sim.bullet.world import BulletWorld
from caretree.sim.scene.scene import BED_TOP
from caretree.skills.core.context import Context
from caretree.skills.core.ports import Key
from caretree.skills.geometry.stances import stance
from caretree.skills.lift_arm import LiftArm
from caretree.skills.lower_arm import LowerArm
from caretree.skills.release_arm import ReleaseArm
from caretree.trees.guard.guard import GuardedWorld
from py_trees.common import Status


class Room:
    """The simulated room with the right arm raised, the robot beside it, the gown on its hook.

    Attributes:
        heights: of elbow, wrist and fingertip over the mattress after each leaf [m].
        loads: greatest pull on the left hand during each leaf [N].
    """

    def __init__(self):
        self.world = BulletWorld(seed=100)
        self.world._person.bend_arm("right", RAISED)
        self.world._robot = self.world._stand(tuple(stance("right", "lift")))
        self.guard = GuardedWorld(self.world)
        self.context = Context(
            world=self.guard, guard=self.guard, seed=100, senses=ClassicalSenses(self.world.room, 100)
        )
        self.heights, self.loads = {"at first": self.height()}, {}

    def height(self):
        """Elbow, wrist and fingertip of the right arm over the mattress [m]."""
        return self.world._person.arms()[1, 1:, 2] - BED_TOP

    def carry_out(self, name, leaf, **ports):
        """Tick a leaf to its end, which is a success."""
        skill, load = leaf(name, self.context, **ports), 0.0
        while True:
            self.guard.check()
            self.context.lease.advance()
            skill.tick_once()
            if skill.status != Status.RUNNING:
                break
            load = max(load, float(np.linalg.norm(self.guard.observe().wrench_hand_in_map[0, :3])))
            self.world.clock.wait_until(self.world.clock.now() + 1 / 15)
        assert skill.status == Status.SUCCESS, skill.failure
        self.heights[name], self.loads[name] = self.height(), load


@pytest.fixture(scope="module")
def room():
    room = Room()
    room.carry_out("put down", LowerArm, side="right", hand="left")
    room.carry_out("lift", LiftArm, side="right", hand="left", hold=Key("hold"))
    room.carry_out("lower", ReleaseArm, hand="left", lower=True)
    yield room
    room.world.close()


def test_the_arm_is_up_before_it_is_put_down_and_before_it_is_lowered(room):
    assert min(room.heights[name][1] for name in ("at first", "lift")) > 0.35


@pytest.mark.parametrize("name", ["put down", "lower"])
def test_the_arm_lies_in_the_end(room, name):
    assert room.heights[name].max() < 0.12


@pytest.mark.parametrize("name", ["put down", "lower"])
def test_it_is_led_down_with_less_force_than_holds_it(room, name):
    assert room.loads[name] < 25.0  # [N]
