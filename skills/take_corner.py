"""Pinch a corner of the hung gown's neckline, where the neckline's tape ends at the shoulder."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import GraspPoint
from ..sim.mechanics.planar import planar_pose
from ..sim.quantity import Quantities, quantity
from ..sim.world import GripperOpening, Side
from .control.fingers import close_gripper, open_gripper
from .control.hand_view import level_view
from .control.hands import cloth_load, hand_now, move_arms, move_hands
from .control.pinch import back_off, grasp_poses, reach_in
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .core.tries import Tries
from .geometry.arm_path import UP
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class TakeCornerTuning(Quantities):
    """Numbers of `TakeCorner`."""

    approach_angles: tuple[float, ...] = quantity(
        tuple(float(np.deg2rad(angle)) for angle in (30.0, 45.0, 15.0, 60.0, 0.0)),
        "rad",
        "of the approach, from the camera's direction towards the hand's own side, in the order of trying",
        "choice: a hand reaches in from its own side with most ease",
    )
    beside_angles: tuple[float, ...] = quantity(
        tuple(float(np.deg2rad(angle)) for angle in (50.0, 30.0, 70.0)),
        "rad",
        "of the hand's view from beside, from straight ahead towards the hand's own side, in the order of trying",
        "choice: drawn with 0.9 rad, the free corner showed whole on 196, edge-on from straight ahead, four times",
    )
    beside_distance: float = quantity(
        0.60, "m", "from the hand's camera to the strip", "choice: all of a strip is in the picture"
    )
    beside_below: float = quantity(0.30, "m", "below the hook, where it looks", "choice: half of the longest strip")
    beside_approaches: tuple[float, ...] = quantity(
        tuple(float(np.deg2rad(angle)) for angle in (0.0, 15.0, -15.0, -30.0, 30.0)),
        "rad",
        "of the approach to a corner seen from beside, from the view's direction likewise",
        "choice: the way it was looked at, or nearly",
    )
    speed: float = quantity(0.5, "m/s", "of the hand on its way to the corner", "choice: nothing is touched yet")
    settle_time: float = quantity(
        0.3, "s", "between arriving and closing the fingers", "choice: the hand comes to rest where it was sent"
    )
    max_age: float = quantity(
        0.5, "s", "of an estimate of the corner that is used without a new look", "choice: the gown sways slowly"
    )
    min_interval: float = quantity(
        0.5, "s", "between two looks from which a drift is extrapolated", "choice: less, and noise would count as drift"
    )
    closing_time: float = quantity(
        1.8,
        "s",
        "from the second look until the fingers have closed, over which the drift is extrapolated",
        "choice: about what the way in and the closing take",
    )
    max_drift: float = quantity(
        0.02, "m", "of the corner over that time", "choice: a larger one is more likely an error of the estimate"
    )
    max_hidden_drift: float = quantity(
        0.04, "m", "of a corner that was missed, since it was seen last", "choice: 9 mm/s for half of a grasp"
    )
    clear_confidence: float = quantity(
        0.5,
        "1",
        "confidence from which a corner was seen, not inferred, and hangs clear of other cloth",
        "design: perception gives less to all other corners",
    )
    tug_distance: float = quantity(0.03, "m", "by which the hand draws what it took, to feel it", "choice: a short way")
    tug_retraction: float = quantity(
        0.5,
        "1",
        "way back along the approach for each metre that the tug rises",
        "choice: mostly up, where cloth pulls",
    )
    tug_speed: float = quantity(0.15, "m/s", "of the hand while it tugs", "choice: slow, so that cloth is not flung")
    attempts: int = quantity(
        3,
        "1",
        "at a corner that the fingers miss, the first one included, before the hand gives it up",
        "measured: hands that closed on nothing had it 0.01 to 0.05 m beside the fingers 11 times of 13: it drifts by "
        "3 to 9 mm/s, hidden by the hand from when that waits before it (121, 127, 140 to 156)",
    )
    wider: float = quantity(0.01, "m", "of the fingers each further time", "choice: half of what it is missed by")
    deeper: float = quantity(0.006, "m", "of the fingertips each further time", "choice: it recedes from the hand too")
    load_samples: int = quantity(
        5, "1", "readings of the force sensor whose mean counts", "choice: a third of a second"
    )
    load_noise: float = quantity(
        0.08, "N", "of a force reading, added to `min_load`", "choice: how it was found is not recorded"
    )


class TakeCorner(Skill):
    """Pinches a corner of the neckline while the gown hangs on its hook with its outside towards the robot.

    The first corner is taken where it was found (`corner`).  The second one is looked for, which is easier when the
    distance at which the other hand holds the first is known (`held_length`); a strip that is edge-on to the head's
    camera shows whole to that of the free hand, from `beside` it.  A short tug tells whether cloth is held.

    It fails where the corner does not show, is out of reach or is not held in the end, and where other cloth has come
    beside a first corner that hung clear of it.  After a failed grasp the hand is open and has drawn back.
    """

    hand = Input(Side, doc="the robot's hand that takes the corner")
    sleeve = Input(Side, doc="the wearer's side that the corner belongs to")
    hook = Input(GraspPoint, unit="m, map", doc="where the gown hangs")
    corner = Input(GraspPoint, unit="m, map", doc="the corner as it was found, for the first one", default=None)
    held_length = Input(
        float, unit="m", doc="of the neckline from the hook to the corner that the other hand holds", default=None
    )
    beside = Input(bool, default=False, doc="whether the hand's own camera looks for it, from beside")
    min_confidence = Input(float, unit="1", doc="least confidence of a corner to go for", default=0.0)
    opening = Input(float, unit="m", doc="between the fingertips on the way in", default=0.05)
    depth = Input(
        float, unit="m", doc="of the fingertips beyond the corner; what hangs behind is not to be taken", default=0.010
    )
    force = Input(float, unit="N", doc="of the grip at most", default=30.0)
    min_load = Input(float, unit="N", doc="least load that the tug must bring", default=0.06)
    tuning = Input(TakeCornerTuning, default=TakeCornerTuning(), doc="numbers of this skill")
    length = Output(float, unit="m", doc="from the hook to the corner")
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
        hook, seen = self.hook, self.corner
        if seen is None or self.now() - seen.stamp > self.tuning.max_age:
            seen = yield from self._find(hook, seen)
        self.note(f"the {self.hand} hand takes the {self.sleeve} corner, confidence {seen.confidence:.2f}")
        if seen.confidence < self.min_confidence:
            raise SkillFailure(Reason.NOTHING_SEEN, f"the {self.sleeve} corner is not seen")
        self._check_clear(seen)
        try:
            seen = yield from self._take(hook, seen)
        except (SkillFailure, MotionError) as miss:
            if isinstance(miss, MotionError) or miss.reason in (Reason.GRASP_MISSED, Reason.MULTI_LAYER):
                yield from self._give_up()
            raise
        self.length = float(np.linalg.norm(seen.position_in_map - hook.position_in_map))

    def _take(self, hook: GraspPoint, seen: GraspPoint) -> Generator[None, None, GraspPoint]:
        """Go in, pinch, tug; a corner that was missed is looked for and taken again, wider and deeper.

        Returns:
            The corner as it was seen last.

        Raises:
            MotionError: it is out of reach.
            SkillFailure: GRASP_MISSED, MULTI_LAYER, or as commands fail.
        """
        tuning, drift, again = self.tuning, np.zeros(3), 0
        while True:
            now = yield from self._go_in(hook, seen, drift, again)
            yield from self.wait(tuning.settle_time)
            try:
                yield from close_gripper(self, self.hand, force=self.force)
                yield from self._tug()
                return now
            except SkillFailure as miss:
                again += 1
                if miss.reason != Reason.GRASP_MISSED or again == tuning.attempts:
                    raise
                yield from self._give_up()  # before the corner, the hand hides it
                try:
                    before, seen = seen, (yield from self._find(hook, seen))
                except PerceptionFailure:  # it has gone farther: another one may show better by now
                    raise miss from None
            passed = max(seen.stamp - before.stamp, tuning.min_interval)
            drift = (seen.position_in_map - before.position_in_map) / passed

    def _find(self, hook: GraspPoint, found: GraspPoint | None) -> Generator[None, None, GraspPoint]:
        """The corner that was found, wherever it has got to, or the other one.

        Raises:
            PerceptionFailure: it does not show.
            MotionError: no view from beside is in reach.
        """
        if self.beside:
            return (yield from self._find_from_beside(hook))
        return self._look(hook, found)

    def _look(self, hook: GraspPoint, found: GraspPoint | None, camera: str = "head") -> GraspPoint:
        """It as a camera sees it now, from where that is."""
        return self.context.senses.hung_corner(
            self.world.look(camera),
            side=self.sleeve,
            hook_in_map=hook.position_in_map,
            other_length=self.held_length,
            near_in_map=None if found is None else found.position_in_map,
        )

    def _find_from_beside(self, hook: GraspPoint) -> Generator[None, None, GraspPoint]:
        """From the first place beside the strip from which the hand's camera shows it well, or as well as it does."""
        tuning, tries = self.tuning, Tries(PerceptionFailure, MotionError)
        ahead = planar_pose(self.world.observe().pose_base_in_map)[:3, 0]
        target, best = hook.position_in_map - tuning.beside_below * UP, None
        for angle in tuning.beside_angles:
            heading = self._turned(angle) @ ahead
            view = level_view(self.world.robot, self.hand, target, heading, tuning.beside_distance)
            with tries:
                yield from move_hands(self, {self.hand: view}, speed=tuning.speed, way="any")
                yield from self.wait(tuning.settle_time)
                seen = self._look(hook, None, f"{self.hand}_hand")
                if seen.confidence >= tuning.clear_confidence:
                    return seen
                best = seen if best is None or seen.confidence > best.confidence else best
        if best is None:
            raise tries.last
        return best

    def _turned(self, angle: float) -> np.ndarray:
        """(3, 3) rotation about the vertical by an angle [rad], positive towards where the hand's own side looks."""
        return planar_pose(np.array((0.0, 0.0, angle if self.hand == "right" else -angle)))[:3, :3]

    def _look_again(self, hook: GraspPoint, seen: GraspPoint, drift: np.ndarray) -> GraspPoint:
        """The same corner where it will be when the fingers close, as the gown turns and sways slowly.

        A corner that no longer shows is taken to have gone on as it did, with `drift` (3,) [m/s].
        """
        tuning = self.tuning
        now = None
        with suppress(PerceptionFailure):
            if not self.beside:  # edge-on, it would be seen elsewhere from the head
                now = self._look(hook, seen)
        if now is None:
            hidden_for = self.now() - seen.stamp + tuning.closing_time
            return _drifted(seen, drift * hidden_for, tuning.max_hidden_drift)
        passed = now.stamp - seen.stamp
        if seen.confidence < tuning.clear_confidence or passed < tuning.min_interval:
            return now
        way = (now.position_in_map - seen.position_in_map) * tuning.closing_time / passed
        return _drifted(now, way, tuning.max_drift)

    def _go_in(
        self, hook: GraspPoint, seen: GraspPoint, drift: np.ndarray, again: int
    ) -> Generator[None, None, GraspPoint]:
        """Come before the corner with open fingers, look again, go in, by the first approach that the arm can make.

        Args:
            hook: where the gown hangs.
            seen: the corner.
            drift: (3,) of it since it was seen before [m/s].
            again: how often it was missed before.

        Returns:
            The corner as it was seen last.

        Raises:
            MotionError: there is none.
        """
        tries = Tries(MotionError)
        opening, depth = self.opening + again * self.tuning.wider, self.depth + again * self.tuning.deeper
        for angle in self.tuning.beside_approaches if self.beside else self.tuning.approach_angles:
            approach = self._turned(angle) @ seen.approach_in_map
            closing = np.cross(approach, UP)
            with tries:
                before, _ = grasp_poses(self, self.hand, seen.position_in_map, approach, closing, depth=depth)
                self.world.send(GripperOpening(side=self.hand, opening=opening), retreat=True)
                yield from move_hands(self, {self.hand: before}, speed=self.tuning.speed, way="any")
                now = self._look_again(hook, seen, drift)
                self._check_clear(now)
                yield from reach_in(
                    self, self.hand, now.position_in_map, approach, closing, opening=opening, depth=depth
                )
                return now
        raise tries.last

    def _check_clear(self, now: GraspPoint) -> None:
        """Refuse a first corner that hung clear of other cloth when it was found, and no longer does.

        Raises:
            SkillFailure: MULTI_LAYER.
        """
        found = self.corner
        if found is not None and now.confidence < self.tuning.clear_confidence <= found.confidence:
            raise SkillFailure(Reason.MULTI_LAYER, f"other cloth has come beside the {self.sleeve} corner")

    def _give_up(self) -> Iterator[None]:
        """Open, draw back, and leave the camera's view."""
        yield from open_gripper(self, self.hand)
        for way_back in (back_off(self, self.hand), move_arms(self, self.world.robot.ready, sides=(self.hand,))):
            try:
                yield from way_back
            except MotionError:  # the other one may do
                continue

    def _tug(self) -> Iterator[None]:
        """Draw the hand up and back a little, and feel whether cloth pulls.

        Raises:
            SkillFailure: GRASP_MISSED when nothing pulls.
        """
        tuning = self.tuning
        pose = hand_now(self, self.hand)
        pose[:3, 3] += tuning.tug_distance * (UP - tuning.tug_retraction * pose[:3, 2])
        yield from move_hands(self, {self.hand: pose}, speed=tuning.tug_speed, free="approach", way="either")
        felt = 0.0
        for _ in range(tuning.load_samples):
            felt += float(np.linalg.norm(cloth_load(self, self.hand))) / tuning.load_samples
            yield
        if felt < self.min_load + tuning.load_noise:  # the hand's camera often sees no cloth so near the fingers
            raise SkillFailure(Reason.GRASP_MISSED, f"the tug was answered by {felt:.2f} N")
        self.context.guard.declare_grip(self.hand, "cloth")
        self.note(f"holds the {self.sleeve} corner, {felt:.2f} N")


def _drifted(seen: GraspPoint, way: np.ndarray, most: float) -> GraspPoint:
    """A corner by `way` (3,) farther on, by `most` at most [m]."""
    way = way * min(1.0, most / max(float(np.linalg.norm(way)), 1e-6))
    return replace(seen, position_in_map=seen.position_in_map + way)
