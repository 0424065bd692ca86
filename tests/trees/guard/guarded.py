"""A guarded world whose left hand is near a person, or far away, and commands to send it."""

import numpy as np
from caretree.sim.scripted.linear_arm import LinearArms
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import HandTwist
from caretree.trees.guard.guard import GuardedWorld


class World(ScriptedWorld):
    """The left hand's home is where the person is told to be."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.kinematics = LinearArms()


def make(near=True, world=None):
    world = world or World()
    guard = GuardedWorld(world)
    hand = world.observe().pose_hand_in_map[0, :3, 3]
    guard.update_person(hand + np.array((0.2, 0, 0) if near else (3.0, 0, 0)), radius=0.05)
    return world, guard


def twist(x=0.0, y=0.0, z=0.0, side="left", duration=0.2):
    return HandTwist(side=side, twist_in_map=np.array((x, y, z, 0, 0, 0)), duration=duration)


def speed(command):
    return float(np.linalg.norm(command.twist_in_map[:3]))


def pull(world, newton, side="left"):
    """Cloth between closed fingers pulls the hand towards -x."""
    world._opening[("left", "right").index(side)] = world._opening_goal[("left", "right").index(side)] = 0.0
    world.load[side] = np.array((-newton, 0, 0, 0, 0, 0), float)
