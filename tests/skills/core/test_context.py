"""Chance comes from the run's seed without telling it: the scene is drawn from the same."""

import numpy as np
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.context import Context
from caretree.skills.testing import OpenGuard


def test_chance_is_that_of_the_seed_and_does_not_name_it():
    guard = OpenGuard(ScriptedWorld())
    context = Context(world=guard, guard=guard, seed=107)
    assert np.array_equal(context.rng.random(5), np.random.default_rng(107).random(5))
    assert context.rng.bit_generator.seed_seq.entropy != 107
    assert 107 not in vars(context).values()
