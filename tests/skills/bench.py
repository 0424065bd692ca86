"""The bench of the leaves' tests: one leaf behind the runner's guard, on a robot of numbers beside the bed."""

from dataclasses import replace

import numpy as np
from caretree.perception.person.arm_fit import turned_about_shoulder
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scene.scene import room_map
from caretree.sim.world import SIDES, GripperOpening
from caretree.skills.control.arm_grip import over_arm
from caretree.skills.core.context import Context
from caretree.skills.geometry.arm_path import ArmPath
from caretree.skills.geometry.stances import stance
from caretree.skills.geometry.strap_grip import StrapGrip, presenting
from caretree.skills.motion.ik import solve_ik
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.skills.testing import Bench
from caretree.trees.guard.guard import GuardedWorld
from py_trees.common import Status

from .fake_senses import fake_senses
from .moving import DeafWorld

PATH = ArmPath.of(lying_posture("right"))  # of the right arm at rest
GRIP = StrapGrip(arm="right", hand="right", across_in_hand=np.array((0.0, 1.0, 0.0)))
CLOTH, ARM = 0.002, 0.07  # between the fingers [m]


class LeafBench(Bench):
    """The bench, with a record of what the robot does.

    Args:
        make: builds the leaf from a context.
        context: builds a world and a context, see `beside_bed`.
        each_tick: called with the bench before each tick, for a world that answers what the robot does.

    Attributes:
        start: observation before the first tick.
        seen: observation after each tick.
    """

    def __init__(self, make, context, each_tick=lambda bench: None):
        super().__init__(make, context)
        self.start, self.seen = self.world.observe(), []
        self._each_tick = each_tick

    def tick(self):
        """One tick, put on record."""
        self._each_tick(self)
        status = super().tick()
        self.seen.append(self.world.observe())
        return status

    def ended(self, seconds=120.0):
        """Run to the end, which comes within `seconds`; returns the reason of a failure, None after a success."""
        status = self.run(int(15 * seconds))
        assert not self.context.errors, self.context.errors[0]
        assert status != Status.RUNNING, "it does not end"
        return self.skill.failure and self.skill.failure.reason

    def poses(self, hand):
        """Poses (n, 4, 4) of a hand after each tick."""
        return np.array([seen.pose_hand_in_map[SIDES.index(hand)] for seen in self.seen])

    def way(self, hand):
        """Positions (n, 3) of a hand after each tick [m]."""
        return self.poses(hand)[:, :3, 3]

    def openings(self, hand):
        """Distances (n,) between the fingertips of a hand after each tick [m]."""
        return np.array([seen.gripper_opening[SIDES.index(hand)] for seen in self.seen])


def beside_bed(*, stand=None, hands=None, held=None, load=None, deaf_to=(), **answers):
    """Builds a world and a context for a bench: `LeafBench(lambda context: Leaf(...), beside_bed(...))`.

    Args:
        stand: base pose (3,); where the person's right arm is lifted from if not given.
        hands: poses (4, 4) by side at which hands begin; the others are ready.
        held: thickness of what closed fingers hold at first, by side [m]: `CLOTH`, `ARM`, 0; the others are open.
        load: force (3,) on the hands by side [N].
        deaf_to: classes of commands that are lost on their way.
        **answers: of the senses, by method.
    """

    def build():
        room, base = room_map(), stance("right", "lift") if stand is None else np.array(stand, float)
        room.waypoints["start"] = tuple(base)
        arms = model.READY.copy()
        for side, pose in (hands or {}).items():
            n = SIDES.index(side)
            arms[n] = solve_ik(kinematics_of(BAXTER), side, pose, base, model.READY[n])
        world = DeafWorld(seed=1, room=room, kinematics=kinematics_of(BAXTER), arm_positions=arms)
        for side, thickness in (held or {}).items():
            world.between_fingers[side] = thickness
            world.send(GripperOpening(side=side, opening=0.0, force_limit=30.0))
        world.clock.wait_until(1.0)
        for side, force in (load or {}).items():
            pulls(world, side, force)
        world.deaf_to = deaf_to
        guard = GuardedWorld(world)
        return world, Context(world=guard, guard=guard, seed=1, senses=fake_senses(**answers))

    return build


def goes_along(posture, then=None):
    """Answer of the sense `arm`: a posture, turned about its shoulder to where a hand holds the arm if one does.

    Once it was held and is no longer, it is as `then`, or as before.
    """
    held = []

    def answer(frame, side, grip_in_map=None, arm_coordinate=1.0):
        if grip_in_map is None:
            return then if held and then is not None else posture
        held.append(arm_coordinate)
        points = turned_about_shoulder(posture.points_in_map, arm_coordinate, grip_in_map)
        return replace(posture, points_in_map=points)

    return answer


def pulls(world, side, force):
    """From now on a force (3,) acts on a hand [N]."""
    world.load[side] = np.append(np.asarray(force, float), np.zeros(3))


def above_arm(coordinate, height=0.09):
    """Pose (4, 4) of the right hand that holds the sleeve `height` [m] above the right arm, at an arm coordinate."""
    return presenting(GRIP, PATH.direction(coordinate), PATH.point(coordinate) + (0.0, 0.0, height))


def on_arm(coordinate, height=0.0):
    """Pose (4, 4) of a hand that points down, its fingers on either side of the right arm at an arm coordinate."""
    return over_arm(lying_posture("right"), coordinate, height)
