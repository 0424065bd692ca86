"""Stage A: one hand takes one shoulder of the hung gown, by the binding of its armhole."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..perception.estimates import GraspPoint
from ..sim.robot.kinematics import planar_pose
from ..sim.world import Side
from .context import Context
from .hands import cloth_load, hand_now, move_hands, open_gripper
from .motion.errors import MotionError
from .pinch import back_off, pinch, reach_in
from .ports import Input, Output
from .reasons import Reason, SkillFailure
from .scripted_gown import offer_gown
from .skill import Skill

TURNS = (0, 20, 40, -20, 60)  # of the approach, from the camera's towards the hand's own side [degrees]
DEPTH = 0.010  # of the fingertips beyond the binding: what lies behind it is not to be taken too [m]
TUG = 0.06  # how far the hand draws what it took, to feel it [m]
UP = np.array((0.0, 0.0, 1.0))


class TakeShoulder(Skill):
    """Pinches the upper end of one armhole's binding while the gown still hangs on its hook.

    Inputs: `hand`; `sleeve`, the wearer's side; `opening` of the fingers on the way in [m]; `force` [N]; `feel`, the
    least load that a tug of 6 cm must bring [N].  Outputs: `grasp`.
    """

    hand = Input(Side)
    sleeve = Input(Side)
    opening = Input(float, default=0.05)
    force = Input(float, default=30.0)
    feel = Input(float, default=0.15)
    grasp = Output(GraspPoint)
    reasons = (Reason.NOTHING_SEEN, Reason.GRASP_MISSED, Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST,
               Reason.PATH_BLOCKED)

    def steps(self) -> Iterator[None]:
        """Look, go in, pinch, tug."""
        self.note(f"the {self.hand} hand takes the {self.sleeve} shoulder")
        seen = self.context.perceive("hung_sleeve", self.world.look("head"), side=self.sleeve)
        yield from self._reach(seen)
        before = cloth_load(self, self.hand)
        try:
            yield from pinch(self, self.hand, force=self.force)
            pose = hand_now(self, self.hand)
            outwards = planar_pose(self.world.observe().pose_base_in_map)[:3, 1] * (1 if self.hand == "left" else -1)
            pose[:3, 3] += TUG * (0.6 * outwards + 0.8 * UP)
            yield from move_hands(self, {self.hand: pose}, speed=0.15, free="approach", way="either")
            yield from self.wait(0.3)
            felt = float(np.linalg.norm(cloth_load(self, self.hand) - before))
            if felt < self.feel:
                raise SkillFailure(Reason.GRASP_MISSED, f"the tug was answered by {felt:.2f} N")
        except SkillFailure as miss:
            if miss.reason is Reason.GRASP_MISSED:
                yield from open_gripper(self, self.hand)
                yield from back_off(self, self.hand)
            raise
        self.grasp = seen

    def _reach(self, seen: GraspPoint) -> Iterator[None]:
        """Go in along the view, or turned towards the hand's own side where that is out of reach."""
        failure: MotionError | None = None
        for degrees in TURNS:
            turn = planar_pose(np.array((0.0, 0.0, np.deg2rad(degrees if self.hand == "right" else -degrees))))[:3, :3]
            approach = turn @ seen.approach_in_map
            try:
                yield from reach_in(self, self.hand, seen.position_in_map, approach, np.cross(approach, UP),
                                    opening=self.opening, depth=DEPTH)
                return
            except MotionError as stop:
                failure = stop
        assert failure is not None
        raise failure

    @classmethod
    def example(cls, context: Context) -> Skill:
        """For the law tests."""
        offer_gown(context)
        return cls("take shoulder", context, hand="left", sleeve="right")
