"""A robot before a rail, away from the bed: cloth pulls at its hands as a test says, and is seen as a test says."""

import numpy as np
from caretree.perception.estimates import GraspPoint
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.mechanics.planar import planar_pose
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld, scripted_room
from caretree.sim.world import SIDES, GripperOpening
from caretree.skills.core.context import Context
from caretree.skills.motion.ik import hand_pose, solve_ik
from caretree.skills.testing.bench import Bench, OpenGuard
from py_trees.common import Status

from .fake_senses import fake_senses

STAND = np.array((2.5, -2.5, 0.0))  # of the base: x [m], y [m], yaw [rad]
AHEAD, LEFT, DOWN = np.eye(3)[0], np.eye(3)[1], -np.eye(3)[2]


def at(ahead, left, up):
    """A point (3,) in the map, given from the middle of the base where it stands at first [m]."""
    return np.array((STAND[0] + ahead, STAND[1] + left, up))


def seen_at(place, target="near_hang", *, stamp=0.0, confidence=0.9, approach=AHEAD):
    """A grasp point that the senses show at a place (3,)."""
    return GraspPoint(
        stamp=stamp,
        confidence=confidence,
        target=target,
        position_in_map=np.asarray(place, float),
        approach_in_map=approach,
        closing_in_map=LEFT,
    )


def holding(**places):
    """Joint angles (2, 7) with hands at places (3,) by side, reached from their own side, the other arm ready."""
    arms = model.READY.copy()
    for side, place in places.items():
        inwards = -0.5 if side == "left" else 0.5
        approach = np.sqrt(0.75) * AHEAD + inwards * LEFT
        pose = hand_pose(place, approach, np.cross(-DOWN, approach))
        n = SIDES.index(side)
        arms[n] = solve_ik(kinematics_of(BAXTER), side, pose, STAND, arms[n])
    return arms


class PullingWorld(ScriptedWorld):
    """Cloth pulls at the hands.

    Attributes:
        pull: `(side, place (3,) of the hand) -> force (3,)` [N], or None for nothing.
        closed: by side, the place (3,) of the hand when its fingers were last told to close, and the time [s].
    """

    pull = None

    def __init__(self, arms):
        room = scripted_room()
        room.waypoints["start"] = tuple(STAND)
        super().__init__(seed=1, room=room, kinematics=kinematics_of(BAXTER), arm_positions=arms)
        self.closed = {}

    def hand(self, side):
        """Pose (4, 4) of a hand in the map."""
        return self.kinematics.pose_hand_in_map(side, self._q[SIDES.index(side)], self._base)

    def observe(self):
        for side in SIDES:
            force = np.zeros(3) if self.pull is None else self.pull(side, self.hand(side)[:3, 3])
            self.load[side] = np.append(force, np.zeros(3))
        return super().observe()

    def send(self, command):
        if isinstance(command, GripperOpening) and command.opening < 0.001:
            self.closed[command.side] = self.hand(command.side)[:3, 3].copy(), self.clock.now()
        return super().send(command)


def bench_with(make, *, arms=model.READY, pull=None, **answers):
    """A bench with the skill that `make(context)` gives; `answers` are those of its senses."""

    def context():
        world = PullingWorld(arms)
        world.pull = pull
        guard = OpenGuard(world)
        return world, Context(world=guard, guard=guard, seed=1, senses=fake_senses(**answers))

    return Bench(make, context)


def ended(bench, *, seconds=60.0, each_tick=lambda: None):
    """Run to the end and call `each_tick` on the way; returns the reason of the failure, or None."""
    while bench.tick() == Status.RUNNING:
        assert bench.world.clock.now() < seconds, "it does not end"
        each_tick()
    assert not bench.context.errors, bench.context.errors[0]
    return bench.skill.failure and bench.skill.failure.reason


def hand_from_base(world, side):
    """Place (3,) of a hand in the frame of the base as it stands now [m]."""
    seen = world.observe()
    base = planar_pose(seen.pose_base_in_map)
    return (np.linalg.inv(base) @ seen.pose_hand_in_map[SIDES.index(side)])[:3, 3]
