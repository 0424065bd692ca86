"""Skills and tasks that do as a test tells them."""

from pathlib import Path

import numpy as np
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import GripperOpening, HandTwist
from caretree.skills.core.ports import Input, Output
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.skills.core.skill import Skill
from caretree.trees.run.runner import Run
from caretree.trees.run.task import Task


class Plan(Skill):
    """Ends as `outcomes` says, one entry per round (True, a Reason, an exception), after `ticks` ticks of motion."""

    outcomes = Input(list)
    ticks = Input(int, default=2)
    given = Input(int, default=None)
    made = Output(int)

    def __init__(self, name, context, **ports):
        super().__init__(name, context, **ports)
        self.rounds = 0

    def steps(self):
        outcome = self.outcomes[min(self.rounds, len(self.outcomes) - 1)]
        self.rounds += 1
        assert self.given is None or isinstance(self.given, int)
        for _ in range(self.ticks):
            if self.commands:
                self.world.send(HandTwist(side="left", twist_in_map=np.array((0.02, 0, 0, 0, 0, 0))))
            yield
        if isinstance(outcome, Reason):
            raise SkillFailure(outcome)
        if isinstance(outcome, BaseException):
            raise outcome
        self.made = self.rounds

    @classmethod
    def example(cls, context):
        return cls("plan", context, outcomes=[True])


class Look(Plan):
    commands = False


class Release(Skill):
    """A safe branch that opens both hands."""

    def steps(self):
        for side in ("left", "right"):
            self.world.send(GripperOpening(side=side, opening=0.08))
        yield from self.until(lambda: self.world.observe().gripper_opening.min() > 0.07, timeout=3.0)


def task_of(build, scripted=None):
    """A task from a function of the context."""
    return Task("planted", build, Path("planted.py"), scripted)


def run_of(build, world=None, **kwargs):
    """A run of a tree on a scripted world, not started."""
    return Run(task_of(build), world or ScriptedWorld(), **kwargs)
