"""The laws of skills.testing, over every skill of the package, behind the runner's own guard."""

import importlib
import pkgutil

import caretree.skills
import caretree.trees.tasks
import pytest
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.context import Context
from caretree.skills.core.skill import Skill
from caretree.skills.scripted.scripted_senses import ScriptedSenses
from caretree.skills.testing import LAWS, Bench
from caretree.trees.guard.guard import GuardedWorld

from .examples import EXAMPLES

for package in (caretree.skills, caretree.trees.tasks):
    for info in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
        importlib.import_module(info.name)
ALL = sorted(
    (kind for kind in Skill.registry if kind.__module__.startswith("caretree.")), key=lambda kind: kind.__name__
)


def guarded():
    """A scripted world behind the guard."""
    world = ScriptedWorld(seed=1)
    guard = GuardedWorld(world)
    return world, Context(world=guard, guard=guard, seed=1, senses=ScriptedSenses(guard))


def test_every_skill_has_an_example():
    assert set(EXAMPLES) == set(ALL)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
@pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.__name__)
def test_every_skill_keeps_every_law(kind, law):
    law(lambda: Bench(EXAMPLES[kind], guarded))
