"""Lift one of the person's arms, slowly and square to it, and spread it, so that a sleeve can be pulled over it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import ArmPosture
from ..perception.image.cloud import unit
from ..sim.world import SIDES, HandTwist, Side
from .belief.person_tracking import careful, watch_arm
from .control.arc import Arc
from .control.arm_grip import ARM_GRIP, lost_arm, over_arm, top_down_reachable
from .control.hands import close_gripper, hand_now, move_hands, open_gripper
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .geometry.arm_path import UP, ArmPath
from .geometry.hold import Hold
from .geometry.stances import HEADWARD, outwards

ABOVE = 0.12  # the open hand waits this far above the arm [m]
DEEPER = 0.005  # the fingertips go this far below the arm's axis [m]
_GAIN = 1.5  # of the correction towards the arc [1/s]
_LATE, _LAG = 0.012, 0.05  # behind the arc: it waits for the hand, and it gives up [m]
_TURN = 0.75  # share of the arm's turn that the hand makes with it
_HEAVY, _HEAVIEST = 26.0, 29.5  # load from which the lift slows down, and at which it stands still [N]
PITCH = float(np.deg2rad(35.0))  # of the whole arm in the end
# How far the upper arm points away from the body in the end, along the bed.  An armhole stops where arm and trunk part:
# pulled up arms that were spread by 0.5, 0.6, 0.75, 0.9 rad and let go of, it came to rest at 0.68, 0.75, 0.81, 0.82 of
# the upper arm (four gowns and persons, both sides).
SPREAD = 0.85
ENOUGH = 0.8  # share of the lift that will do when time is up


class LiftArm(Skill):
    """Takes the upper arm just above the elbow from above and swings it up and outwards about the shoulder.

    The hand moves on an arc: a straight line would pull the arm out of its joint.  Elbow and wrist of a person who
    cannot move keep forearm and hand nearly in line.

    Inputs: `side` of the person; `hand` that lifts; `pitch`, how far the whole arm points up in the end [rad];
    `spread`, how far from the body, if it does not already [rad]; `duration` of the lift of an arm that is not heavy
    [s]; `place` of the grip along the arm (0 shoulder, 1 elbow).
    Output: `hold`, which hand holds the arm where.

    When it fails after the fingers have closed, the arm is still held: recover with `ReleaseArm`.
    """

    side = Input(Side)
    hand = Input(Side)
    pitch = Input(float, default=PITCH)
    spread = Input(float, default=SPREAD)
    duration = Input(float, default=5.5)
    place = Input(float, default=1.0)
    hold = Output(Hold)
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.ARM_SLIPPED,
        Reason.FORCE_LIMIT,
        Reason.TIMEOUT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Look, go over the arm, down, take it, swing it up and out."""
        self.note(f"takes the {self.side} arm")
        posture = watch_arm(self, self.side, period=0.0)
        yield from open_gripper(self, self.hand)
        above = over_arm(posture, self.place, lift=ABOVE)
        place = ArmPath.of(posture).point(self.place)
        arc = Arc(posture.points_in_map[0], place, lifted(posture, self.side, self.place, self.pitch, self.spread))
        above = top_down_reachable(self, self.hand, above, (np.zeros(3), arc.at(arc.whole)[0] - place))
        yield from move_hands(self, {self.hand: above}, way="any", speed=careful(self, 0.5))
        grip = above.copy()
        grip[:3, 3] = place - DEEPER * UP
        yield from move_hands(self, {self.hand: grip}, speed=0.12)
        gap = yield from close_gripper(self, self.hand, force=ARM_GRIP.force)
        if gap < ARM_GRIP.min_gap:
            yield from open_gripper(self, self.hand)
            yield from move_hands(self, {self.hand: above}, retreat=True)
            raise SkillFailure(Reason.GRASP_MISSED, f"the fingers closed to {gap * 1000:.0f} mm: no arm between them")
        self.context.guard.declare_grip(self.hand, "arm")
        self.hold = Hold(self.hand, self.place)
        self.note(f"lifts the {self.side} arm")
        yield from self._swing(posture)

    def _swing(self, posture: ArmPosture) -> Iterator[None]:
        """Follow an arc about the tracked shoulder, a little further on every tick, slower under a heavy arm."""
        n = SIDES.index(self.hand)
        arc = Arc(
            posture.points_in_map[0],
            hand_now(self, self.hand)[:3, 3],
            lifted(posture, self.side, self.place, self.pitch, self.spread),
        )
        end = self.now() + 4.0 * self.duration
        last, swung = self.now(), 0.0
        while swung < arc.whole:
            if lost_arm(self, self.hand):
                raise SkillFailure(Reason.ARM_SLIPPED, f"{swung / arc.whole:.0%} of the way up")
            if self.now() > end and swung > ENOUGH * arc.whole:
                return  # a heavy arm: a few degrees less are no reason to put it down again
            if self.now() > end:
                raise SkillFailure(Reason.TIMEOUT, f"{swung / arc.whole:.0%} of the way up")
            seen = self.world.observe()
            step, last = seen.time - last, seen.time
            load = seen.wrench_hand_in_map[n, :3]
            ease = float(np.clip((_HEAVIEST - np.linalg.norm(load)) / (_HEAVIEST - _HEAVY), 0.0, 1.0))
            wanted, tangent = arc.at(swung)
            behind = wanted + arc.offset - seen.pose_hand_in_map[n, :3, 3]
            ease *= float(np.clip(2.0 - np.linalg.norm(behind) / _LATE, 0.0, 1.0))
            rate = arc.whole / self.duration * ease * min(1.0, 0.2 + swung / 0.1, 0.2 + (arc.whole - swung) / 0.1)
            swung += rate * step
            give = arc.give_way(load, tangent, step)
            if np.linalg.norm(behind) > _LAG:
                raise SkillFailure(Reason.MOTION_BLOCKED, f"the hand is {np.linalg.norm(behind):.2f} m behind")
            linear = rate * arc.radius * tangent + give + _GAIN * behind
            # turning with the arm keeps the hand nearly square to it, and its own arm out of the way of the other hand
            self.world.send(HandTwist(side=self.hand, twist_in_map=np.append(linear, _TURN * rate * arc.axis)))
            try:
                watch_arm(self, self.side, hold=self.hold)
            except PerceptionFailure:
                self.note(f"lifts the {self.side} arm, which it cannot see")
            yield
        yield from self.wait(0.3)
        watch_arm(self, self.side, hold=self.hold, period=0.0)
        if lost_arm(self, self.hand):
            raise SkillFailure(Reason.ARM_SLIPPED, "at the top")


def lifted(posture: ArmPosture, side: Side, place: float, pitch: float, spread: float) -> np.ndarray:
    """Unit vector (3,) from the shoulder to a place of an arm that points up and away from the body; no less than now.

    Args:
        posture: of the arm now.
        side: of the person.
        place: along the arm, 1 is the elbow.
        pitch: of the whole arm above the horizontal [rad].
        spread: of the upper arm away from the body, along the bed [rad].
    """
    path = ArmPath.of(posture)
    now = unit(path.point(place) - path.points[0])
    up = np.arcsin(now[2]) + max(pitch - path.pitch, 0.0)
    aside = max(float(np.arctan2(now @ outwards(side), now @ -HEADWARD)), spread)
    return np.cos(up) * (np.sin(aside) * outwards(side) - np.cos(aside) * HEADWARD) + np.sin(up) * UP
