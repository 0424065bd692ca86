"""Stage D: take the collar near a shoulder, lift it a little, and draw it on until the sleeve sits at the shoulder."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import GraspPoint
from ..perception.image.cloud import unit
from ..sim.world import SIDES, HandTwist, Side
from .belief.armhole_watch import ArmholeWatch
from .belief.person_tracking import watch_arm
from .control.fingers import open_gripper
from .control.hands import cloth_load, hand_now, move_hands
from .control.pinch import pinch, reach_in
from .control.pull_law import PullLaw
from .control.withdraw import withdraw
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .geometry.arm_path import UP, ArmPath
from .geometry.stances import HEADWARD, outwards
from .motion.errors import MotionError

TUGS = 2  # cloth that is stuck under the arm follows a little each time
LIFT = 0.05  # the collar is lifted this far off the body before it is drawn [m]
DRAW = 0.15  # and then drawn at most this far [m]
SPEED = 0.10  # [m/s]
TAUT = 3.5  # a collar that pulls this hard is where it can be [N]
SEATED = -0.45  # place along the arm, beyond its shoulder, where a seated armhole shows: what is seen of it leans over
_STEEPEST = np.deg2rad(35.0)  # the hand comes from above, at most this far off the vertical


class Spread(Skill):
    """Grasps the neck binding near one shoulder and draws it on, along the line of the upper arm and headward.

    That takes the sleeve to the shoulder, where it may have slipped from while the other arm was dressed, and the
    collar to the neck.

    Inputs: `side` of the person; `hand` that does it.  Output: `grasp`, the place it took.
    It ends with the hand open and drawn back, whether it succeeds or misses.
    """

    side = Input(Side)
    hand = Input(Side)
    grasp = Output(GraspPoint)
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.FORCE_LIMIT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Draw the collar, and once more."""
        for tug in range(TUGS):
            try:
                yield from self._tug()
            except (SkillFailure, PerceptionFailure, MotionError):
                if tug == 0:
                    raise
                return  # it has been drawn once already

    def _tug(self) -> Iterator[None]:
        """Take the collar, draw it, let it go."""
        self.note(f"looks for the collar near the {self.side} shoulder")
        path = ArmPath.of(watch_arm(self, self.side))
        point = self.context.senses.collar_near_shoulder(
            self.world.look("head"), side=self.side, shoulder_in_map=path.points[0]
        )
        approach = _from_above(point.approach_in_map, outwards(self.side))
        yield from reach_in(self, self.hand, point.position_in_map, approach, point.closing_in_map)
        try:
            yield from pinch(self, self.hand)
        except SkillFailure as miss:
            if miss.reason == Reason.GRASP_MISSED:
                yield from open_gripper(self, self.hand)
                yield from withdraw(self, [self.hand], 0.12)
            raise
        self.note(f"draws the collar to the neck from the {self.side}")
        lifted = hand_now(self, self.hand)
        lifted[:3, 3] += LIFT * UP
        yield from move_hands(self, {self.hand: lifted}, speed=SPEED, way="either")
        yield from self._draw(path)
        yield from open_gripper(self, self.hand)
        yield from withdraw(self, [self.hand], 0.12)
        self.grasp = point

    def _draw(self, path: ArmPath) -> Iterator[None]:
        """Pull on until the armhole is seen at the shoulder, far enough, or taut."""
        n, law, ring = SIDES.index(self.hand), PullLaw(), ArmholeWatch(self, self.side, self.hand)
        way = unit(unit(-path.direction(0.0) * (1.0, 1.0, 0.0)) + HEADWARD)
        start = hand_now(self, self.hand)[:3, 3]
        end = self.now() + 2.0 * DRAW / SPEED
        while self.now() < end:
            here = self.world.observe().pose_hand_in_map[n, :3, 3]
            load = cloth_load(self, self.hand)
            ring.locate(path, here)
            seated = ring.coordinate is not None and ring.coordinate < SEATED
            if seated or (here - start) @ way > DRAW or np.linalg.norm(load) > TAUT:
                return
            gone = float((here - start) @ way)
            self.note(f"draws the {self.side} collar: {gone * 100:.0f} cm, {np.linalg.norm(load):.1f} N")
            linear = SPEED * law.ease(load) * way
            self.world.send(HandTwist(side=self.hand, twist_in_map=np.append(linear, np.zeros(3))))
            yield


def _from_above(approach: np.ndarray, outward: np.ndarray) -> np.ndarray:
    """The allowed approach nearest to one that is square to the cloth: steep, and from the robot's side of the bed."""
    lean = approach + UP * max(-float(approach @ UP), 0.0)  # the horizontal part
    if lean @ outward > 0.0:
        lean = lean - (lean @ outward) * outward
    angle = min(float(np.arctan2(np.linalg.norm(lean), max(-float(approach[2]), 1e-6))), _STEEPEST)
    return -np.cos(angle) * UP + np.sin(angle) * (unit(lean) if np.linalg.norm(lean) > 1e-6 else np.zeros(3))
