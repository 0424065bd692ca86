"""Stage C: take hold of a sleeve by the strap of its armhole."""

from __future__ import annotations

from collections.abc import Generator, Iterator

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import SleeveOpening
from ..sim.robot import model
from ..sim.robot.kinematics import default_kinematics
from ..sim.world import SIDES, Side
from .arm_path import UP, ArmPath
from .bedside import outwards
from .context import Context
from .hands import hand_now, move_hands, open_gripper
from .holding import holding
from .motion.errors import MotionError
from .motion.ik import hand_pose
from .pinch import back_off, pinch
from .ports import Input, Output
from .reasons import Reason, SkillFailure
from .scripted_person import offer_person
from .skill import Skill
from .strap_approach import way_in
from .strap_grip import StrapGrip, strap_grip
from .tracking import Hold, careful, watch_arm

DISTANCE = 0.29  # from the hand's camera to the strap it looks at [m]
OPENING = 0.06  # of the fingers around the strap, which is 55 mm wide [m]
TO_STRAP = np.array((0.0, -0.05, 0.0))  # from an armhole to its strap, in a gown laid with its collar headward [m]
# The hand points that far below the horizontal when it looks, its camera 35 degrees less: at a sleeve that lies on
# the bed, and at one that hangs over its edge.
_VIEWS_LYING, _VIEWS_HANGING = np.deg2rad((97.0, 80.0, 65.0)), np.deg2rad((52.0, 68.0, 40.0))
_HANGS = 0.03  # a sleeve this far below the mattress hangs over the edge [m]


class GraspSleeve(Skill):
    """Finds the armhole with the head camera, looks at its strap with the hand's camera, and pinches the strap.

    Inputs: `side` of the person; `hand` that grasps; `hold`, the hand that holds the arm meanwhile, or None.
    Output: `grip`, how the strap lies in the fingers.  A miss ends with the hand open and drawn back.
    """

    side = Input(Side)
    hand = Input(Side)
    hold = Input(Hold, default=None)
    grip = Output(StrapGrip)
    reasons = (Reason.NOTHING_SEEN, Reason.ARM_LOST, Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.GRASP_MISSED,
               Reason.ARM_SLIPPED, Reason.COMMAND_LOST)

    def steps(self) -> Iterator[None]:
        """Grasp, easing the hold of the arm on every tick."""
        yield from holding(self, self.hold, self._grasp())

    def _grasp(self) -> Iterator[None]:
        """Look from afar, look from close by, reach in, pinch."""
        self.note(f"looks for the {self.side} sleeve")
        fingertip = watch_arm(self, self.side, hold=self.hold).points_in_map[3]
        frame = self.world.look("head")
        near = fingertip * (1.0, 1.0, 0.0) + self.world.room.bed[1, 2] * UP
        far = self.context.perceive("sleeve_opening", frame, side=self.side, near_in_map=near)
        strap = yield from self._look_closely(far)
        self.note(f"takes the {self.side} sleeve")
        way = way_in(self, self.side, self.hand, strap, ArmPath.of(watch_arm(self, self.side, hold=self.hold)))
        yield from move_hands(self, {self.hand: way.before}, speed=careful(self, 0.3), way="either")
        yield from open_gripper(self, self.hand, OPENING)
        yield from move_hands(self, {self.hand: way.inside}, speed=0.12, way="either")
        pose = hand_now(self, self.hand)
        try:
            yield from pinch(self, self.hand)
        except SkillFailure as miss:
            if miss.reason == Reason.GRASP_MISSED:
                yield from open_gripper(self, self.hand)
                yield from back_off(self, self.hand)
            raise
        self.grip = strap_grip(self.side, self.hand, strap, pose)

    def _look_closely(self, far: SleeveOpening) -> Generator[None, None, SleeveOpening]:
        """Bring the hand's camera in front of the strap; returns the strap as it is seen from there."""
        problem: PerceptionFailure | MotionError | None = None
        hangs = far.position_in_map[2] < self.world.room.bed[1, 2] - _HANGS
        for tilt in _VIEWS_HANGING if hangs else _VIEWS_LYING:
            pose = self._seeing(far.position_in_map + TO_STRAP, tilt)
            try:
                yield from move_hands(self, {self.hand: pose}, way="any", speed=careful(self, 0.5))
            except MotionError as stop:
                problem = problem or stop
                continue
            yield from self.wait(0.15)  # the camera comes to rest
            try:
                return self.context.perceive("sleeve_strap", self.world.look(f"{self.hand}_hand"), side=self.side,
                                             near_in_map=far.position_in_map)
            except PerceptionFailure as stop:
                problem = stop
        assert problem is not None
        raise problem

    def _seeing(self, target: np.ndarray, tilt: float) -> np.ndarray:
        """Hand pose (4, 4) from the robot's side whose camera has `target` in the middle."""
        approach = -np.cos(tilt) * outwards(self.side) - np.sin(tilt) * UP
        pose = hand_pose(np.zeros(3), approach, TO_STRAP)
        camera = _camera_in_hand(self.hand)
        if (pose[:3, :3] @ camera[:3, 2]) @ outwards(self.side) > pose[:3, 2] @ outwards(self.side):
            pose = pose @ np.diag((-1.0, -1.0, 1.0, 1.0))  # the camera's side of the hand towards the robot
        pose[:3, 3] = target - pose[:3, :3] @ (camera[:3, 3] + DISTANCE * camera[:3, 2])
        return pose

    @classmethod
    def example(cls, context: Context) -> Skill:
        """For the law tests."""
        offer_person(context)
        return cls("grasp sleeve", context, side="right", hand="right")


def _camera_in_hand(hand: Side) -> np.ndarray:
    """Pose (4, 4) of a hand's camera in the hand's frame."""
    kinematics, n, base = default_kinematics(), SIDES.index(hand), np.zeros(3)
    camera = kinematics.pose_camera_in_map(f"{hand}_hand", base, model.READY, 0.0)
    return np.linalg.inv(kinematics.pose_hand_in_map(hand, model.READY[n], base)) @ camera
