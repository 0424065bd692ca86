"""A task with a fail-safe, and what has to be so at the end of every run."""

import numpy as np
from caretree.trees.nodes.decorators import FailSafe, Stage

from ..planted import Plan, Release


def assert_at_rest(run, opened=True):
    world = run.world
    before = world.observe().arm_positions
    world.clock.wait_until(world.clock.now() + 1.0)
    assert np.abs(before - world.observe().arm_positions).max() < 5e-3  # [rad] what counts as still may creep on
    if opened:
        assert world.observe().gripper_opening.min() > 0.07


def guarded_task(context, outcome, ticks=5):
    body = Stage("A", None, Plan("p", context, outcomes=[outcome], ticks=ticks))
    return FailSafe("safe", body, Release("let go", context))
