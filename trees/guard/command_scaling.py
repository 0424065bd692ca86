"""Commands made slow enough: speed and separation, as ISO/TS 15066 calls it, before anything moves.

| near the person, or with an arm in the hand | how |
|---|---|
| twists and base velocities | scaled down |
| trajectories | stretched in time |
| grips | with the force that an arm may feel |
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ...sim.segments import furthest_moved
from ...sim.vector import length
from ...sim.world import SIDES, BaseVelocity, GripperOpening, HandTwist, JointTrajectory, Observation, Side
from ...skills.geometry.person_zone import PersonZone
from .declared_grips import DeclaredGrips
from .hand_speed import near_speed, stretched
from .keep_clear import KeepClear
from .limits import Limits
from .link_motion import LinkMotion
from .load_limit import LoadLimit
from .motions_under_way import MotionsUnderWay

LIFT_MIN = 0.05  # [m] shorter motions of a held arm are corrections, not lifts
BOTH_MOVE = 0.7  # [m] further from the person than `near`, an arm may move fast while the base moves too
SHARES = np.linspace(0.0, 1.0, 5)  # of a motion, after which it is looked at where a hand is


class CommandScaling:
    """What of each command may be sent.

    Args:
        links: where commands bring the robot's links.
        limits: what to enforce.
        zone: where the person is.
        load: on the hands.
        grips: what the hands hold.
        under_way: what was sent before; told of what is sent now.
    """

    def __init__(
        self,
        links: LinkMotion,
        *,
        limits: Limits,
        zone: PersonZone,
        load: LoadLimit,
        grips: DeclaredGrips,
        under_way: MotionsUnderWay,
    ) -> None:
        self._limits, self._zone = limits, zone
        self._load, self._grips, self._under_way = load, grips, under_way
        self._links = links
        self._clear = KeepClear(links, zone)

    def twist(self, command: HandTwist, seen: Observation, retreat: bool) -> HandTwist:
        """A hand's twist: slower under load and near the person, and off the person and the robot itself."""
        side, twist = command.side, np.array(command.twist_in_map, float)
        twist *= self._load.ease(side, twist[:3], seen, retreat)
        hand = seen.pose_hand_in_map[SIDES.index(side), :3, 3]
        carried = self._under_way.carried(side, seen)
        speed = length(twist[:3])
        ahead = _ahead(hand, twist[:3], command.duration)
        near = bool((self._zone.distance(ahead) < self._limits.near_person + carried * command.duration).any())
        if near or self._grips.holds_arm(side):
            limit = max(self._speed_limit(side) - carried, 0.0)
            if speed > limit:
                twist *= limit / speed
        twist = self._clear.twist(command, twist, seen, self._grips.arms)
        after = self._links.after_twist(seen, side, twist, command.duration)
        twist *= self._slow_links(seen, after, command.duration, carried)
        self._under_way.arm_moves(side, length(twist[:3]), command.duration)
        return replace(command, twist_in_map=twist)

    def trajectory(self, command: JointTrajectory, seen: Observation, retreat: bool) -> JointTrajectory:
        """A trajectory, stretched as a whole by what its slowest part needs.

        Raises:
            SkillFailure: it goes too near the person or the robot itself, or pulls at a load that is at its limit.
        """
        factor, fastest = 1.0, {}
        for side in SIDES:
            if (bound := self._along(command, side, seen, retreat)) is not None:
                factor, fastest[side] = max(factor, bound[0]), bound[1]
        self._clear.trajectory(command, seen, self._grips.arms)
        for side, speed in fastest.items():
            self._under_way.arm_moves(side, speed / factor, float(command.times[-1]) * factor)
        return stretched(command, factor) if factor > 1.0 else command

    def base(self, command: BaseVelocity, seen: Observation, retreat: bool) -> BaseVelocity:
        """A velocity of the base, which carries both hands and all links."""
        velocity, factor = np.array(command.velocity, float), 1.0
        x, y, yaw = seen.pose_base_in_map
        c, s = math.cos(yaw), math.sin(yaw)
        turn = np.array(((c, -s), (s, c)))
        hands = seen.pose_hand_in_map[:, :3, 3]
        for n, side in enumerate(SIDES):
            arm = hands[n, :2] - (x, y)
            planar = turn @ velocity[:2] + velocity[2] * np.array((-arm[1], arm[0]))
            motion = np.append(planar, 0.0)
            factor = min(factor, self._load.ease(side, motion, seen, retreat))
            speed = length(motion)
            ahead = _ahead(hands[n], motion, command.duration)
            own = self._under_way.arm_speed(side)
            # an arm on its way was judged with the base at rest: moving both keeps further away
            reach = self._limits.near_person + (own * command.duration if own <= self._speed_limit(side) else BOTH_MOVE)
            near = bool((self._zone.distance(ahead) < reach).any())
            if speed > 0 and (near or self._grips.holds_arm(side)):
                factor = min(factor, max(self._speed_limit(side) - own, 0.0) / speed)
        command = replace(command, velocity=factor * velocity)
        factor *= self._clear.base(command, seen, self._grips.arms)
        after = self._links.after_base(seen, factor * velocity, command.duration)
        factor *= self._slow_links(seen, after, command.duration)
        velocity *= factor
        self._under_way.base_moves(velocity, command.duration)
        return replace(command, velocity=velocity)

    def grip(self, command: GripperOpening, seen: Observation) -> GripperOpening:
        """An opening of the fingers, soft near the person and round an arm."""
        self._grips.told(command, seen)
        hand = seen.pose_hand_in_map[SIDES.index(command.side), :3, 3]
        if self._zone.distance(hand)[0] < self._limits.near_person or self._grips.holds_arm(command.side):
            return replace(command, force_limit=min(command.force_limit, self._limits.grip_force_arm))
        return command

    def _along(
        self, command: JointTrajectory, side: Side, seen: Observation, retreat: bool
    ) -> tuple[float, float] | None:
        """How much a trajectory is stretched by the way that an arm's links go, and its hand's speed [m/s].

        None where it does not move that arm.
        """
        links = self._links
        walked = links.hand_path(command, side, seen)
        if walked is None:
            return None
        times, path = walked
        rows, factor = links.rows(side), 1.0
        ease = self._load.ease(side, path[-1] - path[0], seen, retreat)
        carried = self._under_way.carried(side, seen)
        reach = self._limits.near_person + (BOTH_MOVE if carried > 0.0 else 0.0)
        _, ends = links.along(command, seen)
        speed = near_speed(times, ends[:, rows], links.radii[rows], self._zone, reach)
        steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
        fastest = float((steps / np.maximum(np.diff(times), 1e-9)).max(initial=0.0))
        if self._grips.holds_arm(side):
            speed = fastest
            if np.linalg.norm(path - path[0], axis=1).max() > LIFT_MIN:
                factor = self._limits.lift_duration / max(float(times[-1]), 1e-9)
        limit = max(self._speed_limit(side) - carried, 1e-3)
        return max(factor, speed / limit, 1.0 / max(ease, 0.05)), fastest

    def _slow_links(self, seen: Observation, after: np.ndarray, duration: float, already: float = 0.0) -> float:
        """Share of a motion, after which the links are at `after` (r, 2, 3), that keeps those near the person slow."""
        if duration <= 0.0:
            return 1.0
        here, radii = self._links.ends(seen), self._links.radii
        speed = furthest_moved(here, after) / duration
        limit = max(self._near_limit() - already, 0.0)
        fast = speed > limit
        if not fast.any():
            return 1.0
        gap = np.minimum(*(self._zone.link_distance(ends[fast], radii[fast]) for ends in (here, after)))
        near = gap < self._limits.near_person + already * duration
        return limit / float(speed[fast][near].max()) if near.any() else 1.0

    def _speed_limit(self, side: Side) -> float:
        near = self._near_limit()
        return min(self._limits.lift_speed, near) if self._grips.holds_arm(side) else near

    def _near_limit(self) -> float:
        return self._limits.hand_speed * self._limits.hand_speed_commanded


def _ahead(hand: np.ndarray, velocity: np.ndarray, duration: float) -> np.ndarray:
    """Where (5, 3) a hand passes that moves on like that."""
    return hand + (SHARES * duration)[:, None] * velocity
