"""Thinking takes time of the world."""

import numpy as np
import pytest
from caretree.sim.bullet.thinking_time import ThinkingTime
from caretree.sim.bullet.world import BulletWorld
from caretree.sim.world import BaseVelocity, JointTrajectory
from caretree.sim.world_kind import EASY_KIND, WorldKind

KIND = WorldKind.named("easy+thinking_time")
WAY = {"times": np.array((0.0, 0.5)), "positions": np.array(((0.0,), (0.2,)))}
PLANNED, HEAD = JointTrajectory(joints=("left_w2",), **WAY), JointTrajectory(joints=("head_pan",), **WAY)
AT_ONCE = BaseVelocity(velocity=np.array((0.2, 0.0, 0.0)), duration=0.2)


def test_in_the_easy_world_it_takes_none():
    thinking = ThinkingTime(100, EASY_KIND)
    thinking.saw()
    thinking.decided(PLANNED)
    assert thinking.spend() == 0.0


def test_images_and_plans_cost_what_the_table_says_and_are_paid_once():
    costs = {"image": [], "plan": []}
    thinking = ThinkingTime(100, KIND)
    for _ in range(300):
        thinking.saw()
        costs["image"].append(thinking.spend())
        thinking.decided(PLANNED)
        costs["plan"].append(thinking.spend())
        assert thinking.spend() == 0.0
    assert 0.01 <= min(costs["image"]) < 0.012 < 0.048 < max(costs["image"]) <= 0.05
    assert 0.1 <= min(costs["plan"]) < 0.12 < 0.48 < max(costs["plan"]) <= 0.5
    thinking.decided(AT_ONCE)
    thinking.decided(HEAD)
    assert thinking.spend() == 0.0


@pytest.mark.parametrize(("kind", "late"), [("easy", False), ("easy+thinking_time", True)])
def test_the_world_goes_on_before_what_was_thought_of_is_done(kind, late):
    world = BulletWorld(seed=101, kind=kind)
    world.send(AT_ONCE)
    assert world.clock.now() == 0.0
    frame = world.look("head")
    assert frame.stamp == world.clock.now() == 0.0, "an image is worked through after it was taken"
    world.send(AT_ONCE)
    worked = world.clock.now()
    assert (0.0099 <= worked <= 0.0525) == late
    assert (worked > 0.0) == late
    world.send(PLANNED)
    planned = world.clock.now() - worked
    assert (0.0999 <= planned <= 0.5025) == late
    world.look("head")
    begin = world.clock.now()
    world.clock.wait_until(begin)
    assert (world.clock.now() > begin) == late, "or before the next tick, where no command came of it"
    world.close()


def test_stopping_needs_no_thinking():
    world = BulletWorld(seed=101, kind="easy+thinking_time")
    world.look("head")
    world.stop()
    assert world.clock.now() == 0.0
    world.close()
