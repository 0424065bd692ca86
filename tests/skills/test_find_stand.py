"""Where to stand to lift an arm and to take its sleeve."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.context import Context
from caretree.skills.find_stand import FindStand
from caretree.skills.geometry.stances import stance
from caretree.skills.scripted.scripted_person import laid_strap, lying_posture
from caretree.trees.guard.guard import GuardedWorld
from py_trees.common import Status

from .fake_senses import fake_senses


def chosen(sleeve):
    """The base pose (3,) for an arm at rest and a sleeve that is seen, or not."""
    world = ScriptedWorld()
    guard = GuardedWorld(world)
    context = Context(
        world=guard,
        guard=guard,
        senses=fake_senses(sleeve_opening=sleeve, arm=lying_posture("right")),
    )
    skill = FindStand("stand", context, side="right", lifting="left", pulling="right")
    for _ in range(60):
        skill.tick_once()
        world.clock.wait_until(world.clock.now() + 1 / 15)
        if skill.status != Status.RUNNING:
            break
    assert skill.status == Status.SUCCESS
    return skill.stand


def moved(offset):
    strap = laid_strap("right")
    return replace(strap, position_in_map=strap.position_in_map + offset)


def test_the_usual_stance_will_do():
    np.testing.assert_allclose(chosen(moved((-0.12, 0.0, 0.0))), stance("right", "lift"))


def test_a_sleeve_at_the_robots_feet_makes_it_stand_elsewhere():
    base = chosen(moved((0.10, -0.35, 0.0)))
    assert np.linalg.norm(base - stance("right", "lift")) > 0.05
    assert base[2] == pytest.approx(stance("right", "lift")[2])


def test_a_sleeve_out_of_sight_changes_nothing():
    hidden = PerceptionFailure(Problem.NOTHING_SEEN, "sleeve")
    np.testing.assert_allclose(chosen(hidden), stance("right", "lift"))
