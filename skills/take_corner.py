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
from .control.hands import close_gripper, cloth_load, hand_now, move_arms, move_hands, open_gripper
from .control.pinch import back_off, grasp_poses, reach_in
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .motion.errors import MotionError

TURNS = (30, 45, 15, 60, 0)  # of the approach, from the camera's towards the hand's own side [degrees]
DEPTH = 0.010  # of the fingertips beyond the corner: what lies behind it is not to be taken too [m]
SETTLE = 0.3  # until the hand stands where it was sent [s]
SPEED = 0.5  # of the hand until it is near [m/s]
CLOSES_IN = 1.8  # from the second look until the fingers have closed [s]
FRESH = 0.5  # age of a corner that need not be looked for again [s]
DRIFT = 0.02  # of the corner until then, at most [m]
CERTAIN = 0.5  # confidence of a corner that was seen, not inferred
TUG = 0.03  # how far the hand draws what it took, to feel it [m]
NOISE = 0.08  # of a force reading [N]
UP = np.array((0.0, 0.0, 1.0))


class TakeCorner(Skill):
    """Pinches a corner of the neckline while the gown hangs on its hook, outside to the robot.

    Takes the first corner where it was `found`.  For the second one, `held` tells how far from the hook the other hand
    holds the first.

    Inputs: `hand`; `sleeve`, the wearer's side; `hook`, where it hangs; `found`, for the first corner, and `held` [m],
    for the second; `sure`, the least confidence of a corner; `opening` of the fingers on the way in and `depth` of
    their tips beyond the corner [m]; `force` [N]; `feel`, the least load that a tug of 3 cm must bring [N].

    Outputs: `length` from the hook to the corner [m].
    """

    hand = Input(Side)
    sleeve = Input(Side)
    hook = Input(GraspPoint)
    found = Input(GraspPoint, default=None)
    held = Input(float, default=None)
    sure = Input(float, default=0.0)
    opening = Input(float, default=0.05)
    depth = Input(float, default=DEPTH)
    force = Input(float, default=30.0)
    feel = Input(float, default=0.06)
    length = Output(float)
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.GRASP_MISSED,
        Reason.MULTI_LAYER,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Look, go in, pinch, tug."""
        hook, seen = self.hook, self.found
        if seen is None or self.now() - seen.stamp > FRESH:
            seen = self._look(hook)
        self.note(f"the {self.hand} hand takes the {self.sleeve} corner, confidence {seen.confidence:.2f}")
        if seen.confidence < self.sure:
            raise SkillFailure(Reason.NOTHING_SEEN, f"the {self.sleeve} corner is not seen")
        self._check_clear(seen)
        try:
            seen = yield from self._go_in(hook, seen)
            yield from self.wait(SETTLE)
            yield from close_gripper(self, self.hand, force=self.force)
            yield from self._tug()
        except (SkillFailure, MotionError) as miss:
            if isinstance(miss, MotionError) or miss.reason in (Reason.GRASP_MISSED, Reason.MULTI_LAYER):
                yield from self._give_up()
            raise
        self.length = float(np.linalg.norm(seen.position_in_map - hook.position_in_map))

    def _look(self, hook: GraspPoint) -> GraspPoint:
        found = self.found
        return self.context.senses.hung_corner(
            self.world.look("head"),
            side=self.sleeve,
            hook_in_map=hook.position_in_map,
            other_length=self.held,
            near_in_map=None if found is None else found.position_in_map,
        )

    def _look_again(self, hook: GraspPoint, seen: GraspPoint) -> GraspPoint:
        """The same corner where it will be when the fingers close: the gown turns and sways slowly.

        As it was where it no longer shows.
        """
        try:
            now = self.context.senses.hung_corner(
                self.world.look("head"),
                side=self.sleeve,
                hook_in_map=hook.position_in_map,
                near_in_map=seen.position_in_map,
            )
        except PerceptionFailure:
            return seen
        passed = now.stamp - seen.stamp
        if seen.confidence < CERTAIN or passed < 0.5:
            return now
        drift = (now.position_in_map - seen.position_in_map) * CLOSES_IN / passed
        drift *= min(1.0, DRIFT / max(float(np.linalg.norm(drift)), 1e-6))
        return replace(now, position_in_map=now.position_in_map + drift)

    def _go_in(self, hook: GraspPoint, seen: GraspPoint) -> Generator[None, None, GraspPoint]:
        """Wait before the corner with open fingers, look again, go in; from the hand's own side, as far as it can.

        Returns:
            The corner as it was seen last.

        Raises:
            MotionError: from nowhere.
        """
        failure: MotionError | None = None
        for degrees in TURNS:
            turn = planar_pose(np.array((0.0, 0.0, np.deg2rad(degrees if self.hand == "right" else -degrees))))[:3, :3]
            approach = turn @ seen.approach_in_map
            closing = np.cross(approach, UP)
            try:
                before, _ = grasp_poses(self, self.hand, seen.position_in_map, approach, closing, depth=self.depth)
                self.world.send(GripperOpening(side=self.hand, opening=self.opening), retreat=True)
                yield from move_hands(self, {self.hand: before}, speed=SPEED, way="any")
                now = self._look_again(hook, seen)
                self._check_clear(now)
                yield from reach_in(
                    self, self.hand, now.position_in_map, approach, closing, opening=self.opening, depth=self.depth
                )
                return now
            except MotionError as stop:
                failure = stop
        assert failure is not None
        raise failure

    def _check_clear(self, now: GraspPoint) -> None:
        """Do not take a first corner that hung clear of other cloth when it was found and does so no longer.

        Raises:
            SkillFailure: MULTI_LAYER.
        """
        if self.found is not None and now.confidence < CERTAIN <= self.found.confidence:
            raise SkillFailure(Reason.MULTI_LAYER, f"other cloth has come beside the {self.sleeve} corner")

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
