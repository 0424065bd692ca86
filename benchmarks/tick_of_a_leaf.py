"""Processor time of a tick of a skill beside one of a bare leaf of py_trees: `python benchmarks/tick_of_a_leaf.py`.

Both wait and do nothing else.  The least of several rounds counts, as others use the machine meanwhile.
"""

import time
from collections.abc import Iterator
from typing import ClassVar

from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.context import Context
from caretree.skills.core.skill import Skill
from caretree.trees.guard.guard import GuardedWorld
from py_trees.behaviour import Behaviour
from py_trees.common import Status

TICKS, ROUNDS = 5_000, 20


class Bare(Behaviour):
    """What py_trees itself costs."""

    def update(self) -> Status:
        """Go on waiting."""
        return Status.RUNNING


class Waits(Skill):
    """A skill that waits."""

    commands: ClassVar[bool] = True

    def steps(self) -> Iterator[None]:
        """Go on waiting."""
        while True:
            yield


def tick(leaf: Behaviour) -> float:
    """Processor time of one tick [us]."""
    least = float("inf")
    for _ in range(ROUNDS):
        began = time.process_time()
        for _ in range(TICKS):
            leaf.tick_once()
        least = min(least, (time.process_time() - began) / TICKS)
    return 1e6 * least


guard = GuardedWorld(ScriptedWorld())
bare, skill = tick(Bare("bare")), tick(Waits("waits", Context(world=guard, guard=guard)))
print(f"bare leaf {bare:.2f} us, skill {skill:.2f} us: {skill - bare:.2f} us more, {skill / bare:.2f} times")
