"""Take the collar near a shoulder, lift it a little, and draw it on until the sleeve sits at the shoulder."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import GraspPoint
from ..perception.image.cloud import unit
from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, HandTwist, Side
from .belief.armhole_watch import ArmholeWatch
from .belief.person_motion import while_person_rests
from .belief.person_tracking import watch_arm
from .control.fingers import open_gripper
from .control.hands import cloth_load, hand_now, move_hands
from .control.pinch import pinch, reach_in
from .control.withdraw import withdraw
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .geometry.arm_path import UP, ArmPath
from .geometry.stances import HEADWARD, outwards
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class SpreadTuning(Quantities):
    """Numbers of `Spread`."""

    tugs: int = quantity(
        2, "1", "times that the collar is drawn", "choice: cloth that is stuck under the arm follows a little each time"
    )
    max_tilt: float = quantity(
        float(np.deg2rad(35.0)), "rad", "of the approach off the vertical", "choice: the hand comes from above"
    )
    lift: float = quantity(0.05, "m", "of the collar off the body before it is drawn", "choice: it does not rub")
    distance: float = quantity(0.15, "m", "by which the collar is drawn at most", "choice: as far as to the neck")
    speed: float = quantity(0.10, "m/s", "of the hand that holds the collar", "choice: slow at the neck")
    timeout_factor: float = quantity(
        2.0,
        "1",
        "of the time that the whole distance takes at full speed",
        "choice: room for a guard that slows it down",
    )
    max_load: float = quantity(
        3.5, "N", "of the collar, at which it is as far as it goes", "choice: it is then where it can be"
    )
    seated: float = quantity(
        -0.45,
        "1",
        "arm coordinate below which an armhole that is seen sits at the shoulder",
        "choice: what is seen of a seated armhole leans over beyond the shoulder",
    )
    withdrawal: float = quantity(0.12, "m", "by which the open hand is drawn back", "choice: clear of the collar")


class Spread(Skill):
    """Grasps the neckline's tape near one shoulder and draws it on, along the line of the upper arm and headward.

    That takes the sleeve back to the shoulder, from which it may have slipped while the other arm was dressed, and the
    collar to the neck.  It fails where the collar could not be drawn even once.  The hand ends open and drawn back
    after a success and after a missed grasp.
    """

    side = Input(Side, doc="the person's side")
    hand = Input(Side, doc="the robot's hand that draws the collar")
    tuning = Input(SpreadTuning, default=SpreadTuning(), doc="numbers of this skill")
    grasp = Output(GraspPoint, unit="m, map", doc="where the collar was taken")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.PERSON_MOVED,
        Reason.FORCE_LIMIT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Draw the collar as long as the person does not move."""
        yield from while_person_rests(self, self._twice())

    def _twice(self) -> Iterator[None]:
        """Draw the collar, and once more."""
        for tug in range(self.tuning.tugs):
            try:
                yield from self._tug()
            except (SkillFailure, PerceptionFailure, MotionError):
                if tug == 0:
                    raise
                return  # it has been drawn once already

    def _tug(self) -> Iterator[None]:
        """Take the collar, draw it, let it go."""
        tuning = self.tuning
        self.note(f"looks for the collar near the {self.side} shoulder")
        path = ArmPath.of(watch_arm(self, self.side))
        point = self.context.senses.collar_near_shoulder(
            self.world.look("head"), side=self.side, shoulder_in_map=path.points[0]
        )
        approach = _from_above(point.approach_in_map, outwards(self.side), tuning.max_tilt)
        yield from reach_in(self, self.hand, point.position_in_map, approach, point.closing_in_map)
        try:
            yield from pinch(self, self.hand)
        except SkillFailure as miss:
            if miss.reason == Reason.GRASP_MISSED:
                yield from open_gripper(self, self.hand)
                yield from withdraw(self, [self.hand], tuning.withdrawal)
            raise
        self.note(f"draws the collar to the neck from the {self.side}")
        lifted = hand_now(self, self.hand)
        lifted[:3, 3] += tuning.lift * UP
        yield from move_hands(self, {self.hand: lifted}, speed=tuning.speed, way="either")
        yield from self._draw(path)
        yield from open_gripper(self, self.hand)
        yield from withdraw(self, [self.hand], tuning.withdrawal)
        self.grasp = point

    def _draw(self, path: ArmPath) -> Iterator[None]:
        """Draw until the armhole is seen at the shoulder, the collar has come far enough, or it pulls too hard."""
        tuning, n, armhole = self.tuning, SIDES.index(self.hand), ArmholeWatch(self, self.side, self.hand)
        way = unit(unit(-path.direction(0.0) * (1.0, 1.0, 0.0)) + HEADWARD)
        start = hand_now(self, self.hand)[:3, 3]
        end = self.now() + tuning.timeout_factor * tuning.distance / tuning.speed
        while self.now() < end:
            here = self.world.observe().pose_hand_in_map[n, :3, 3]
            load = cloth_load(self, self.hand)
            armhole.locate(path, here)
            seated = armhole.coordinate is not None and armhole.coordinate < tuning.seated
            if seated or (here - start) @ way > tuning.distance or np.linalg.norm(load) > tuning.max_load:
                return
            gone = float((here - start) @ way)
            self.note(f"draws the {self.side} collar: {gone * 100:.0f} cm, {np.linalg.norm(load):.1f} N")
            linear = tuning.speed * way
            self.world.send(HandTwist(side=self.hand, twist_in_map=np.append(linear, np.zeros(3))))
            yield


def _from_above(approach: np.ndarray, outward: np.ndarray, max_tilt: float) -> np.ndarray:
    """The approach nearest to one square to the cloth that comes from above and from the robot's side of the bed.

    Args:
        approach: (3,) unit vector, square to the cloth.
        outward: (3,) unit vector from the body's middle to the robot's side.
        max_tilt: of the approach off the vertical [rad].
    """
    lean = approach + UP * max(-float(approach @ UP), 0.0)  # the horizontal part
    if lean @ outward > 0.0:
        lean = lean - (lean @ outward) * outward
    angle = min(float(np.arctan2(np.linalg.norm(lean), max(-float(approach[2]), 1e-6))), max_tilt)
    return -np.cos(angle) * UP + np.sin(angle) * (unit(lean) if np.linalg.norm(lean) > 1e-6 else np.zeros(3))
