"""A robot of numbers, away from the bed, that carries out one motion of `skills.control` at a time."""

import numpy as np
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld, scripted_room
from caretree.skills.core.context import Context
from caretree.skills.core.reasons import Reason
from caretree.skills.core.skill import Skill
from caretree.trees.guard.guard import GuardedWorld
from py_trees.common import Status

from .fake_senses import fake_senses


class DeafWorld(ScriptedWorld):
    """Commands of the class `deaf_to` are lost on their way."""

    deaf_to = ()

    def send(self, command):
        return command if isinstance(command, self.deaf_to) else super().send(command)


class Mover(Skill):
    """Does what it is given: a function from the skill to a generator.

    Attributes:
        result: what the generator returned.
    """

    reasons = tuple(Reason)

    def __init__(self, context, motion):
        super().__init__("mover", context)
        self._motion = motion
        self.result = None

    def steps(self):
        self.result = yield from self._motion(self)


def robot(base=(2.5, -2.5, 0.0), *, deaf_to=(), **answers):
    """World and context of a robot that stands at `base` (3,), its arms ready; `answers` are those of its senses."""
    room = scripted_room()
    room.waypoints["start"] = base
    room.bed[1, 2] = 0.6  # as in the simulated room: hands that are ready pass over the person's legs
    world = DeafWorld(seed=1, room=room, kinematics=kinematics_of(BAXTER), arm_positions=model.READY)
    world.deaf_to = deaf_to
    guard = GuardedWorld(world)
    return world, Context(world=guard, guard=guard, seed=1, senses=fake_senses(**answers))


def carry_out(world, context, motion, *, each_tick=lambda skill: None, seconds=200.0):
    """Tick until the motion has ended; returns the skill, which knows its `result` or its `failure`."""
    skill = Mover(context, motion)
    while world.clock.now() < seconds:
        context.lease.advance()
        skill.tick_once()
        if skill.status != Status.RUNNING:
            assert not context.errors, context.errors[0]
            return skill
        each_tick(skill)
        world.clock.wait_until(world.clock.now() + 1 / 15)
    raise AssertionError("it does not end")


def idle(context):
    """A skill that may look at the world and does nothing."""
    return Mover(context, lambda skill: iter(()))


def angle_between(a, b):
    """Angle between two unit vectors [rad]."""
    return float(np.arccos(np.clip(a @ b, -1.0, 1.0)))
