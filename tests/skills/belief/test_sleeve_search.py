"""A sleeve that was seen well is known while something stands before it, until somebody takes hold of it."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.belief.sleeve_search import find_sleeve, seen_well
from caretree.skills.core.context import Context
from caretree.skills.grasp_sleeve import GraspSleeve
from caretree.skills.look_for_sleeve import LookForSleeve
from caretree.skills.scripted.scripted_person import laid_strap, lying_posture
from caretree.skills.scripted.scripted_senses import ScriptedSenses
from caretree.trees.guard.guard import GuardedWorld
from py_trees.common import Status

from ..fake_senses import fake_senses

WELL, BADLY = laid_strap("right"), replace(laid_strap("right"), confidence=0.2, position_in_map=np.zeros(3))
HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "sleeve")


def room(*views, hide_strap=False):
    """A context whose camera shows the sleeve in these ways, one after the other, and as in the last from then on."""
    world = ScriptedWorld()
    guard = GuardedWorld(world)
    context = Context(world=guard, guard=guard)
    sleeve = fake_senses(sleeve_opening=list(views))

    class Seen(ScriptedSenses):
        sleeve_opening = sleeve.sleeve_opening

        def sleeve_strap(self, frame, *, side, near_in_map):
            if hide_strap:
                raise HIDDEN
            return super().sleeve_strap(frame, side=side, near_in_map=near_in_map)

    context.offer_senses(Seen(guard))
    return context


def ran(skill):
    for _ in range(600):
        skill.tick_once()
        skill.world.clock.wait_until(skill.world.clock.now() + 1 / 15)
        if skill.status != Status.RUNNING:
            return skill.status
    raise AssertionError("it does not end")


@pytest.mark.parametrize("later", [BADLY, HIDDEN])
def test_what_was_seen_well_counts_while_it_does_not_show(later):
    skill = LookForSleeve("look", room(WELL, later), side="right", hand="right")
    assert ran(skill) == Status.SUCCESS
    seen = find_sleeve(skill, "right", lying_posture("right").points_in_map)
    np.testing.assert_allclose(seen.position_in_map, WELL.position_in_map)


def test_a_sleeve_that_never_shows_is_no_failure_to_look_but_one_to_take():
    context = room(HIDDEN)
    assert ran(LookForSleeve("look", context, side="right", hand="right")) == Status.SUCCESS
    assert ran(GraspSleeve("grasp", context, side="right", hand="right")) == Status.FAILURE


def test_a_sleeve_that_is_not_where_it_was_seen_well_is_forgotten():
    context = room(WELL, BADLY, hide_strap=True)
    assert ran(LookForSleeve("look", context, side="right", hand="right")) == Status.SUCCESS
    skill = GraspSleeve("grasp", context, side="right", hand="right")
    assert seen_well(skill)
    assert ran(skill) == Status.FAILURE
    assert not seen_well(skill)
