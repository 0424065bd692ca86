"""Lift one of the person's arms, slowly and square to it, and spread it, so that a sleeve can be pulled over it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import ArmPosture
from ..perception.image.cloud import unit
from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, HandTwist, Side
from .belief.person_motion import while_person_rests
from .belief.person_tracking import careful, watch_arm
from .belief.short_gown import short_gown
from .control.arc import Arc
from .control.arm_grip import lost_arm, over_arm, top_down_reachable
from .control.fingers import open_gripper
from .control.hands import hand_now, move_hands
from .control.take_arm import TakeArmTuning, close_around
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .geometry.arm_path import ELBOW, UP, ArmPath
from .geometry.hold import Hold
from .geometry.stances import HEADWARD, outwards


@dataclass(frozen=True, kw_only=True)
class LiftGoal(Quantities):
    """Where an arm is taken, and where it is brought."""

    grip_coordinate: float = quantity(
        1.0,
        "1",
        "arm coordinate of the grip: 0 shoulder, 1 elbow",
        "choice: one hand at the elbow carries forearm and upper arm",
    )
    bent_from: float = quantity(
        float(np.deg2rad(35.0)), "rad", "of an elbow, from which it is bent", "choice: at rest it is by 6 to 20 degrees"
    )
    bent_grip: float = quantity(
        0.82,
        "1",
        "arm coordinate of the grip of an arm whose elbow is bent",
        "choice: 5 cm from the elbow, a forearm's radius and half a finger's width: at the corner of one bent by 75 "
        "degrees a finger came down on the forearm with 46 to 65 N, six times of six (101)",
    )
    approach_height: float = quantity(
        0.12, "m", "of the open hand above the arm, before it goes down", "choice: clear of it"
    )
    pitch: float = quantity(
        float(np.deg2rad(35.0)), "rad", "of the whole arm above the horizontal in the end", "choice: clear of the bed"
    )
    spread: float = quantity(
        0.60,
        "rad",
        "of the upper arm away from the body in the end, along the bed, if it does not point there already",
        "measured: from 0.64 to 0.72 rad, the gown's pull at the hand went from 1.4 to 3.1 N, and its sleeve missed it "
        "(149); an arm that is in its sleeve may be spread farther as it is lowered",
    )
    straight: float = quantity(
        0.99,
        "1",
        "share of the arm's length between shoulder and grip in the end, where it is held beyond the elbow",
        "choice: straight to what is known of its length; a bent elbow met the mattress before the hand was down (101)",
    )
    near_spread: float = quantity(
        0.4,
        "rad",
        "the same once the gown did not reach the hand of an arm that was spread by more",
        "choice: its fingertips then are 0.15 m farther feetward; at those of one spread by 0.85 rad the gown pulled "
        "with 4.5 N and more, three times in the same way (174, 183)",
    )


@dataclass(frozen=True, kw_only=True)
class LiftArmTuning(Quantities):
    """How an arm is taken and swung up."""

    goal: LiftGoal = field(default_factory=LiftGoal)
    take: TakeArmTuning = field(default_factory=TakeArmTuning)
    duration: float = quantity(5.5, "s", "of the swing of an arm that is not heavy", "choice: gentle on the shoulder")
    timeout_factor: float = quantity(
        4.0, "1", "greatest duration of the swing, in times of `duration`", "choice: room for a heavy arm"
    )
    min_lift: float = quantity(
        0.8,
        "1",
        "share of the swing that will do when time is up",
        "choice: a few degrees less are no reason to put a heavy arm down again",
    )
    start_share: float = quantity(
        0.2, "1", "share of the full rate at which the swing begins and ends", "choice: no jerk at either end"
    )
    ramp: float = quantity(
        0.1, "rad", "angle over which the rate grows by its full value", "choice: no jerk at either end"
    )
    slow_from: float = quantity(
        26.0, "N", "load from which the swing slows down", "choice: below `stop_at`, to ease off"
    )
    stop_at: float = quantity(
        29.5, "N", "load at which the swing stands still", "choice: below the 30 N that the guard allows on an arm"
    )
    full_speed_lag: float = quantity(
        0.012, "m", "of the hand behind the arc, from which on the arc waits, and at twice that stands", "choice: small"
    )
    max_lag: float = quantity(
        0.05, "m", "of the hand behind the arc, beyond which it gives up", "choice: it is blocked"
    )
    lag_gain: float = quantity(
        1.5, "1/s", "of the correction towards the arc", "choice: stable at the rate of the ticks"
    )
    turn_share: float = quantity(
        0.75,
        "1",
        "share of the arm's turn that the hand makes with it",
        "choice: nearly square to the arm, and its own arm out of the other hand's way",
    )
    settle_time: float = quantity(
        0.3, "s", "waited at the top, before the last look", "choice: the last command runs out"
    )


class LiftArm(Skill):
    """Takes the upper arm just above the elbow from above and swings it up and outwards about the shoulder.

    The hand moves on an arc: a straight line would pull the arm out of its joint.  Elbow and wrist of a person who
    cannot move keep forearm and hand nearly in line.  Taken beyond the elbow, the arm is looked at again from above it,
    and straightened on the way.

    It fails where the arm is not seen or out of reach, where the fingers close on nothing or lose the arm, where the
    swing is blocked or takes too long, and where the person moves.  When it fails after the fingers have closed, the
    arm is still held: recover with `ReleaseArm`.
    """

    side = Input(Side, doc="arm of the person")
    hand = Input(Side, doc="hand that lifts")
    hold = Output(Hold, doc="which hand holds the arm where")
    tuning = Input(LiftArmTuning, default=LiftArmTuning(), doc="numbers of this skill")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.ARM_SLIPPED,
        Reason.PERSON_MOVED,
        Reason.FORCE_LIMIT,
        Reason.TIMEOUT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Lift the arm as long as the person does not move."""
        yield from while_person_rests(self, self._lift())

    def _lift(self) -> Iterator[None]:
        """Look, go over the arm, down, take it, swing it up and out."""
        tuning = self.tuning
        self.note(f"takes the {self.side} arm")
        posture = watch_arm(self, self.side, period=0.0)
        goal = goal_for(self, self.side, posture, tuning.goal)
        yield from open_gripper(self, self.hand)
        above = over_arm(posture, goal.grip_coordinate, lift=goal.approach_height)
        place = ArmPath.of(posture).point(goal.grip_coordinate)
        arc = self._arc(posture, place, goal)
        above = top_down_reachable(self, self.hand, above, (np.zeros(3), arc.at(arc.angle)[0] - place))
        yield from move_hands(self, {self.hand: above}, way="any", speed=careful(self, tuning.take.approach_speed))
        if goal.grip_coordinate > ELBOW:
            posture = self.look_again()
            place = ArmPath.of(posture).point(goal.grip_coordinate)
        around = above.copy()
        around[:3, 3] = place + tuning.take.grip_depth * above[:3, 2]
        yield from close_around(self, self.hand, above, around, tuning=tuning.take)
        self.hold = Hold(self.hand, goal.grip_coordinate)
        self.note(f"lifts the {self.side} arm")
        yield from self._swing(posture, goal)

    def look_again(self) -> ArmPosture:
        """Where the arm is by now: a forearm that nothing carries slides on while the hand comes (102)."""
        return watch_arm(self, self.side, period=0.0)

    def _arc(self, posture: ArmPosture, start: np.ndarray, goal: LiftGoal) -> Arc:
        """From where the arm is held (3,) to where it is brought; held beyond the elbow, it is straightened as well."""
        shoulder, reach = posture.points_in_map[0], None
        if goal.grip_coordinate > ELBOW:
            straight = goal.straight * ArmPath.of(posture).distance(0.0, goal.grip_coordinate)
            reach = max(straight, float(np.linalg.norm(start - shoulder)))
        return Arc(shoulder, start, lifted(posture, self.side, goal), reach=reach)

    def _swing(self, posture: ArmPosture, goal: LiftGoal) -> Iterator[None]:
        """Follow an arc about the tracked shoulder, a little further on every tick, slower under a heavy arm."""
        tuning, n = self.tuning, SIDES.index(self.hand)
        arc = self._arc(posture, hand_now(self, self.hand)[:3, 3], goal)
        end = self.now() + tuning.timeout_factor * tuning.duration
        last, swung = self.now(), 0.0
        while swung < arc.angle:
            if lost_arm(self, self.hand):
                raise SkillFailure(Reason.ARM_SLIPPED, f"{swung / arc.angle:.0%} of the way up")
            if self.now() > end and swung > tuning.min_lift * arc.angle:
                return
            if self.now() > end:
                raise SkillFailure(Reason.TIMEOUT, f"{swung / arc.angle:.0%} of the way up")
            seen = self.world.observe()
            step, last = seen.time - last, seen.time
            load = seen.wrench_hand_in_map[n, :3]
            ease = np.clip((tuning.stop_at - np.linalg.norm(load)) / (tuning.stop_at - tuning.slow_from), 0.0, 1.0)
            wanted, tangent = arc.at(swung)
            behind = wanted + arc.offset - seen.pose_hand_in_map[n, :3, 3]
            ease *= np.clip(2.0 - np.linalg.norm(behind) / tuning.full_speed_lag, 0.0, 1.0)
            rate = arc.angle / tuning.duration * float(ease) * self._ramp(swung, arc.angle)
            onwards, swung = arc.velocity(swung, rate), swung + rate * step
            give = arc.give_way(load, tangent, seen.time, step)
            if np.linalg.norm(behind) > tuning.max_lag:
                raise SkillFailure(Reason.MOTION_BLOCKED, f"the hand is {np.linalg.norm(behind):.2f} m behind")
            linear = onwards + give + tuning.lag_gain * behind
            twist = np.append(linear, tuning.turn_share * rate * arc.axis)
            self.world.send(HandTwist(side=self.hand, twist_in_map=twist))
            try:
                watch_arm(self, self.side, hold=self.hold)
            except PerceptionFailure:
                self.note(f"lifts the {self.side} arm, which it cannot see")
            yield
        yield from self.wait(tuning.settle_time)
        watch_arm(self, self.side, hold=self.hold, period=0.0)
        if lost_arm(self, self.hand):
            raise SkillFailure(Reason.ARM_SLIPPED, "at the top")

    def _ramp(self, swung: float, whole: float) -> float:
        """Share of the full rate after an angle `swung` of a `whole` swing [rad]: little at either end."""
        start, ramp = self.tuning.start_share, self.tuning.ramp
        return min(1.0, start + swung / ramp, start + (whole - swung) / ramp)


def goal_for(skill: Skill, side: Side, posture: ArmPosture, goal: LiftGoal) -> LiftGoal:
    """Where an arm is taken and brought, as far as is known of it and the gown.

    One whose elbow is bent is taken above the elbow, and one whose hand the gown did not reach is brought less far
    aside.

    Args:
        skill: that asks.
        side: of the person.
        posture: of the arm.
        goal: for an arm that is nearly straight, and a gown that is long enough.
    """
    if goal.bent_grip < goal.grip_coordinate <= ELBOW and ArmPath.of(posture).bend > goal.bent_from:
        goal = replace(goal, grip_coordinate=goal.bent_grip)
    return replace(goal, spread=goal.near_spread) if side in short_gown(skill) else goal


def lifted(posture: ArmPosture, side: Side, goal: LiftGoal) -> np.ndarray:
    """Unit vector (3,) from the shoulder to the grip of an arm that points up and away from the body; no less than now.

    Args:
        posture: of the arm now.
        side: of the person.
        goal: where the grip is, and how far up and away the arm is brought.
    """
    path = ArmPath.of(posture)
    now = unit(path.point(goal.grip_coordinate) - path.points[0])
    up = math.asin(now[2]) + max(goal.pitch - path.pitch, 0.0)
    aside = max(math.atan2(now @ outwards(side), now @ -HEADWARD), goal.spread)
    return math.cos(up) * (math.sin(aside) * outwards(side) - math.cos(aside) * HEADWARD) + math.sin(up) * UP
