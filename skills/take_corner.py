"""Stage A: one hand takes one corner of the hung gown's neckline, where the binding ends at the shoulder."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import replace

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import GraspPoint
from ..sim.robot import model
from ..sim.robot.kinematics import planar_pose
from ..sim.world import GripperOpening, Side
from .context import Context
from .driving import drive_to
from .hands import close_gripper, cloth_load, hand_now, move_arms, move_hands, open_gripper
from .motion.errors import MotionError
from .pinch import back_off, grasp_poses, reach_in
from .ports import Input, Output
from .reasons import Reason, SkillFailure
from .scripted_gown import offer_gown
from .skill import Skill

TURNS = (30, 45, 15, 60, 0)  # of the approach, from the camera's towards the hand's own side [degrees]
DEPTH = 0.010  # of the fingertips beyond the corner: what lies behind it is not to be taken too [m]
STAND = 1.0  # before the hook, where both hands turn freely and the camera sees the whole gown [m]
NEAR_ENOUGH = 0.04  # of the place to stand [m]
SETTLE = 0.3  # until the hand stands where it was sent [s]
SPEED = 0.5  # of the hand until it is near [m/s]
CLOSES_IN = 1.8  # from the second look until the fingers have closed [s]
DRIFT = 0.02  # of the corner until then, at most [m]
CERTAIN = 0.5  # confidence of a corner that was seen, not inferred
TUG = 0.03  # how far the hand draws what it took, to feel it [m]
NOISE = 0.08  # of a force reading [N]
UP = np.array((0.0, 0.0, 1.0))


class TakeCorner(Skill):
    """Pinches a corner of the neckline while the gown hangs on its hook, outside to the robot.

    Takes the first corner where it hangs.  For the second one, `held` tells how far from the hook the other hand holds
    the first.

    Inputs: `hand`; `sleeve`, the wearer's side; `known_hook`, where it hangs, and `held` [m], for the second corner;
    `opening` of the fingers on the way in and `depth` of their tips beyond the corner [m]; `force` [N]; `feel`, the
    least load that a tug of 3 cm must bring [N].

    Outputs: `hook`; `length` from it to the corner [m].
    """

    hand = Input(Side)
    sleeve = Input(Side)
    known_hook = Input(GraspPoint, default=None)
    held = Input(float, default=None)
    opening = Input(float, default=0.05)
    depth = Input(float, default=DEPTH)
    force = Input(float, default=30.0)
    feel = Input(float, default=0.06)
    hook = Output(GraspPoint)
    length = Output(float)
    reasons = (Reason.NOTHING_SEEN, Reason.GRASP_MISSED, Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST,
               Reason.PATH_BLOCKED)

    def steps(self) -> Iterator[None]:
        """Stand before the hook, look, go in, pinch, tug."""
        self.note(f"the {self.hand} hand takes the {self.sleeve} corner")
        hook = self.known_hook
        if hook is None:
            yield from self._stand(self.context.perceive("hook", self.world.look("head")).position_in_map)
            hook = self.context.perceive("hook", self.world.look("head"))
        seen = self._look(hook)
        self.note(f"the {self.hand} hand takes the {self.sleeve} corner, confidence {seen.confidence:.2f}")
        approach = yield from self._come_near(seen)
        seen = self._look_again(hook, seen)
        yield from reach_in(self, self.hand, seen.position_in_map, approach, np.cross(approach, UP),
                            opening=self.opening, depth=self.depth)
        yield from self.wait(SETTLE)
        try:
            yield from close_gripper(self, self.hand, force=self.force)
            yield from self._tug()
        except SkillFailure as miss:
            if miss.reason is Reason.GRASP_MISSED:
                yield from self._give_up()
            raise
        self.hook, self.length = hook, float(np.linalg.norm(seen.position_in_map - hook.position_in_map))

    def _look(self, hook: GraspPoint) -> GraspPoint:
        return self.context.perceive("hung_corner", self.world.look("head"), side=self.sleeve,
                                     hook_in_map=hook.position_in_map, other_length=self.held)

    def _look_again(self, hook: GraspPoint, seen: GraspPoint) -> GraspPoint:
        """The same corner where it will be when the fingers close: the gown turns and sways slowly.

        As it was where it no longer shows.
        """
        try:
            now = self.context.perceive("hung_corner", self.world.look("head"), side=self.sleeve,
                                        hook_in_map=hook.position_in_map, near_in_map=seen.position_in_map)
        except PerceptionFailure:
            return seen
        passed = now.stamp - seen.stamp
        if seen.confidence < CERTAIN or passed < 0.5:
            return now
        drift = (now.position_in_map - seen.position_in_map) * CLOSES_IN / passed
        drift *= min(1.0, DRIFT / max(float(np.linalg.norm(drift)), 1e-6))
        return replace(now, position_in_map=now.position_in_map + drift)

    def _stand(self, hook_in_map: np.ndarray) -> Iterator[None]:
        """Step without turning until the hook is straight ahead."""
        pose = self.world.observe().pose_base_in_map
        goal = np.append(hook_in_map[:2] - STAND * planar_pose(pose)[:2, 0], pose[2])
        if np.linalg.norm(goal - pose) > NEAR_ENOUGH:
            yield from drive_to(self, goal, straight=True)

    def _come_near(self, seen: GraspPoint) -> Generator[None, None, np.ndarray]:
        """Wait before the corner with open fingers, on the hand's own side; returns the approach (3,)."""
        failure: MotionError | None = None
        for degrees in TURNS:
            turn = planar_pose(np.array((0.0, 0.0, np.deg2rad(degrees if self.hand == "right" else -degrees))))[:3, :3]
            approach = turn @ seen.approach_in_map
            try:
                before, _ = grasp_poses(self, self.hand, seen.position_in_map, approach, np.cross(approach, UP),
                                        depth=self.depth)
                self.world.send(GripperOpening(side=self.hand, opening=self.opening), retreat=True)
                yield from move_hands(self, {self.hand: before}, speed=SPEED, way="any")
                return approach
            except MotionError as stop:
                failure = stop
        assert failure is not None
        raise failure

    def _give_up(self) -> Iterator[None]:
        """Open, draw back, and out of the camera's sight."""
        yield from open_gripper(self, self.hand)
        for way_back in (back_off(self, self.hand), move_arms(self, model.READY, sides=(self.hand,))):
            try:
                yield from way_back
            except MotionError:  # the other one may do
                continue

    def _tug(self) -> Iterator[None]:
        """Draw a little, up and back; cloth that is held pulls.

        Raises:
            SkillFailure: GRASP_MISSED when nothing does.
        """
        pose = hand_now(self, self.hand)
        pose[:3, 3] += TUG * (UP - 0.5 * pose[:3, 2])
        yield from move_hands(self, {self.hand: pose}, speed=0.15, free="approach", way="either")
        felt = 0.0
        for _ in range(5):
            felt += float(np.linalg.norm(cloth_load(self, self.hand))) / 5
            yield
        if felt < self.feel + NOISE:  # the hand's camera often sees no cloth so near the fingers
            raise SkillFailure(Reason.GRASP_MISSED, f"the tug was answered by {felt:.2f} N")
        self.context.guard.declare_grip(self.hand, "cloth")
        self.note(f"holds the {self.sleeve} corner, {felt:.2f} N")

    @classmethod
    def example(cls, context: Context) -> Skill:
        """For the law tests."""
        offer_gown(context)
        return cls("take corner", context, hand="right", sleeve="left", feel=-1.0)
