"""The guard: a world that keeps the limits, whoever commands it.

The runner wraps every world in it, so that a task author cannot leave it out.  It

- keeps every link slow near the person, by scaling twists and base velocities and by stretching trajectories;
- keeps every link off the person and off the robot's other links (`keep_clear.py`);
- scales pulling down as the cloth load grows, stops at the limit, and then lets only relieving motion pass;
- caps the grip on an arm and the speed of a hand that holds one;
- stops the run when the senses are stale, frozen or gone, or the emergency stop is pressed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from ...sim.abilities import HasKinematics
from ...sim.freshness import fresh_frame, fresh_observation
from ...sim.segments import furthest_moved
from ...sim.vector import length
from ...sim.world import (
    SIDES,
    BaseVelocity,
    Command,
    EmergencyStop,
    Frame,
    GripperOpening,
    HandTwist,
    JointTrajectory,
    Observation,
    SensorLost,
    SensorStale,
    Side,
    World,
)
from ...skills.core.context import Grip
from ...skills.core.reasons import Failure, Reason, SkillFailure, reason_of
from ...skills.geometry.person_zone import PersonZone
from .hand_speed import hand_path, hand_positions_from, near_speed, near_speed_bound, stretched
from .keep_clear import KeepClear
from .limits import DEFAULT, Limits
from .link_motion import LinkMotion
from .watchdog import Watchdog

LIFT_MIN = 0.05  # [m] shorter motions of a held arm are corrections, not lifts
BOTH_MOVE = 0.7  # [m] further from the person than `near`, an arm may move fast while the base moves too
OPENED = 0.01  # [m] a command that opens the fingers by this much lets go
SHARES = np.linspace(0.0, 1.0, 5)  # of a motion, after which it is looked at where a hand is
ARM_OPENING = 0.03  # [m] between fingers that do not hold cloth, at least: no adult's arm is thinner


class GuardedWorld:
    """A world behind the limits.  It passes on the contract and nothing else, so truth stays out of reach.

    Args:
        inner: the world.  Where it has no kinematics, trajectories near the person are bounded by the arm's reach,
            which is safe and slow, and no link is kept off the person.
        limits: what to enforce.
        on_command: told of every command really sent.
        before_command: called before each command is sent.
        on_sample: called for every sample with a new time.

    Attributes:
        zone: where the person is, as skills have told.
    """

    def __init__(
        self,
        inner: World,
        limits: Limits = DEFAULT,
        *,
        on_command: Callable[[Command], None] | None = None,
        before_command: Callable[[], None] = lambda: None,
        on_sample: Callable[[Observation], None] = lambda seen: None,
    ) -> None:
        self.limits = limits
        self._on_command = on_command
        self._before_command, self._on_sample = before_command, on_sample
        self._under_way = -np.inf  # world clock until which what has been sent moves something
        self.clock = inner.clock
        self.room = inner.room
        self._inner = inner
        self.robot = inner.robot
        self.zone = PersonZone(inner.room.bed, limits.person_above_bed)
        self._watchdog = Watchdog(limits)
        kinematics = inner.kinematics if isinstance(inner, HasKinematics) else None
        self._hand_positions = hand_positions_from(kinematics)
        self._links = None if kinematics is None else LinkMotion(inner.robot, kinematics)
        self._clear = None if self._links is None else KeepClear(self._links, self.zone)
        self._held: dict[Side, str] = {}  # hand -> the arm that it holds
        self._ends: np.ndarray | None = None
        self._opening = np.zeros(2)
        self._grip: dict[Side, Grip] = {"left": "nothing", "right": "nothing"}
        self._over = {side: False for side in SIDES}
        self._fault: Failure | None = None
        self._base_until, self._base_speed = -np.inf, np.zeros(2)
        self._arm_until = {side: -np.inf for side in SIDES}  # what the arm itself was last told to do
        self._arm_speed = {side: 0.0 for side in SIDES}
        self._last: Observation | None = None
        self._heavy_since: dict[Side, float | None] = {side: None for side in SIDES}
        self._fast_since: float | None = None

    # -- what skills tell and ask ------------------------------------------------------------------------

    def update_person(self, points_in_map: np.ndarray, *, part: str = "person", radius: float = 0.06) -> None:
        """Say where a part of the person is: a chain of points (n, 3) and its radius [m]."""
        self.zone.update(points_in_map, part=part, radius=radius)

    def declare_grip(self, side: Side, what: Grip) -> None:
        """Say what a hand holds.  Which load is too high is told by how far its fingers stand apart, not by this."""
        self._grip[side] = what
        self._held.pop(side, None)
        arm = self.zone.nearest_arm(self.observe().pose_hand_in_map[SIDES.index(side), :3, 3])
        if what == "arm" and arm is not None:
            self._held[side] = arm

    @property
    def seen(self) -> Observation | None:
        """What was sensed last, for those who watch; None before anything was."""
        return self._last

    def held_arms(self) -> Mapping[Side, str]:
        """By hand, the person's arm that it holds, as the zone names it."""
        return self._held

    def grip(self, side: Side) -> Grip:
        """What a hand was said to hold."""
        return self._grip[side]

    def take_fault(self) -> Failure | None:
        """The failure held against the running skill, once."""
        fault, self._fault = self._fault, None
        return fault

    def still(self) -> bool:
        """Whether neither arms nor base move; raises SensorLost."""
        seen = self.observe()
        return bool(
            np.abs(seen.arm_velocities).max() < self.limits.still_joint_speed
            and np.abs(seen.twist_base).max() < self.limits.still_base_speed
        )

    def was_stopped(self, failure: Failure, since: float) -> bool:
        """Take note that something else has stopped the robot.

        Args:
            failure: why; held against the running skill where a motion was under way.
            since: world clock from which on it may have been stopped [s].

        Returns:
            Whether a motion was under way.
        """
        moving = since < self._under_way
        if moving:
            self._under_way, self._fault = -np.inf, failure
        return moving

    def check(self) -> Failure | None:
        """Judge the state once per tick.

        Returns:
            What must stop the whole run (dead senses, the emergency stop), or None.  An excess of load or speed stops
            the motion at once and is held against the running skill instead.
        """
        try:
            pressed = self.observe().emergency_stop
        except SensorLost as lost:
            return self._watchdog.judge(self.clock.now()) and Failure(reason_of(lost), str(lost), "guard")
        except EmergencyStop:
            pressed = True
        if pressed:
            return Failure(Reason.EMERGENCY_STOP, "", "robot")
        return self._watchdog.judge(self.clock.now())

    # -- World -------------------------------------------------------------------------------------------

    def observe(self) -> Observation:
        """Latest proprioception, judged; raises SensorLost, also where it is too old."""
        seen = fresh_observation(self._inner.observe(), self.clock.now(), self.limits.stale_after)
        self._watchdog.sample(seen, self.clock.now())
        self._opening = seen.gripper_opening
        self._judge_load(seen)
        if self._last is None or seen.time > self._last.time:
            self._on_sample(seen)
            for side, arm in self._held.items():  # it goes with the hand, seen or not
                self.zone.move_arm(arm, seen.pose_hand_in_map[SIDES.index(side), :3, 3])
            self._judge_speed(seen)
        self._last = seen
        return seen

    def look(self, camera: str) -> Frame:
        """Latest frame.

        Raises:
            SensorLost: the camera is dead, its frame too old, or it no longer varies.
        """
        frame = fresh_frame(self._inner.look(camera), self.clock.now(), self.limits.frame_stale_after)
        if fault := self._watchdog.frame(frame):
            raise SensorStale(fault)
        return frame

    def send(self, command: Command, *, retreat: bool = False) -> Command:
        """Start a motion as far as the limits allow.

        Args:
            command: what to do.
            retreat: the motion takes load off the person, whatever its direction.

        Returns:
            What was really sent.

        Raises:
            SensorLost: nobody knows where the robot is.
            EmergencyStop: it is pressed.
            SkillFailure: the load is at its limit and the motion does not relieve it.
        """
        seen = self.observe()
        if seen.emergency_stop:
            raise EmergencyStop("nothing moves before a person has released it")
        if isinstance(command, HandTwist):
            command = self._slow_twist(command, seen, retreat)
        elif isinstance(command, JointTrajectory):
            command = self._slow_trajectory(command, seen, retreat)
        elif isinstance(command, BaseVelocity):
            command = self._slow_base(command, seen, retreat)
        else:
            command = self._soft_grip(command, seen)
        self._before_command()
        sent = self._inner.send(command)
        self._under_way = max(self._base_until, *self._arm_until.values())
        if self._on_command is not None:
            self._on_command(sent)
        return sent

    def stop(self) -> None:
        """End every motion now."""
        self._forget_motions()
        self._inner.stop()

    def _forget_motions(self) -> None:
        self._base_until = self._under_way = -np.inf
        self._arm_until = {side: -np.inf for side in SIDES}

    def close(self) -> None:
        """Release what the world holds."""
        self._inner.close()

    # -- limits ------------------------------------------------------------------------------------------

    def _judge_load(self, seen: Observation) -> None:
        for n, side in enumerate(SIDES):
            load = length(seen.wrench_hand_in_map[n, :3])
            limit = self._load_stop(side)
            if load >= limit and self._lasts(side, load, seen.time) and not self._over[side]:
                self._over[side] = True
                self.stop()
                detail = f"{load:.1f} N on the {side} hand, limit {limit:g} N"
                self._fault = Failure(Reason.FORCE_LIMIT, detail, "guard")
            elif load < limit:
                self._heavy_since[side] = None
            if load < limit * self.limits.cloth_load_rearm / self.limits.cloth_load_stop:
                self._over[side] = False

    def _lasts(self, side: Side, load: float, time: float) -> bool:
        """Whether a load above the limit counts: the pull of a held arm has to last, or to be far above it."""
        if not self._wide(side) or load >= self.limits.arm_load_peak:
            return True
        since = self._heavy_since[side]
        if since is None:
            self._heavy_since[side] = time
            return False
        return time - since > self.limits.arm_load_for

    def _judge_speed(self, seen: Observation) -> None:
        """Hold a link that has been too fast near the person against the running skill."""
        if self._links is None:
            ends = np.repeat(seen.pose_hand_in_map[:, None, :3, 3], 2, axis=1)
            names, radii = tuple(f"{side}_hand" for side in SIDES), np.zeros(len(SIDES))
        else:
            ends, radii, names = self._links.ends(seen), self._links.radii, self._links.names
        before, self._ends = self._ends, ends
        last = self._last
        if last is None or before is None:
            return
        speed = furthest_moved(before, ends) / (seen.time - last.time)
        fast = speed > self.limits.hand_speed * self.limits.overspeed_factor
        if fast.any():
            fast[fast] = self.zone.link_distance(ends[fast], radii[fast]) < self.limits.near_person
        if not fast.any():
            self._fast_since = None
        elif self._fast_since is None:
            self._fast_since = last.time
        elif seen.time - self._fast_since > self.limits.overspeed_for:
            self._fast_since = None
            self.stop()
            n = int(np.argmax(np.where(fast, speed, 0.0)))
            self._fault = Failure(Reason.SPEED_LIMIT, f"{names[n].replace('_', ' ')} at {speed[n]:.2f} m/s", "guard")

    def _wide(self, side: Side) -> bool:
        """Whether fingers stand too far apart to hold cloth: what they feel is an arm, or contact."""
        return bool(self._opening[SIDES.index(side)] > ARM_OPENING)

    def _load_stop(self, side: Side) -> float:
        return self.limits.arm_load_stop if self._wide(side) else self.limits.cloth_load_stop

    def _ease(self, side: Side, motion: np.ndarray, seen: Observation, retreat: bool) -> float:
        """Factor 0 to 1 for a hand's `motion` (3,) under its present load; raises SkillFailure at the limit."""
        force = seen.wrench_hand_in_map[SIDES.index(side), :3]
        load, stop = length(force), self._load_stop(side)
        if retreat or not motion.any() or float(motion @ force) > 0.0:
            return 1.0  # the hand moves the way it is pulled, or away: relief must stay possible
        if load >= stop and self._wide(side) and not self._over[side]:
            return 0.0  # it waits for the load to fall, or to have lasted too long
        if load >= stop:
            raise SkillFailure(Reason.FORCE_LIMIT, f"{load:.1f} N on the {side} hand, limit {stop:g} N")
        slow = self.limits.cloth_load_slow
        if self._wide(side) or load <= slow:
            return 1.0
        return (stop - load) / (stop - slow)

    def _speed_limit(self, side: Side) -> float:
        held = self._grip[side] == "arm"
        return min(self.limits.lift_speed, self._near_limit()) if held else self._near_limit()

    def _near_limit(self) -> float:
        return self.limits.hand_speed * self.limits.hand_speed_commanded

    def _slow_twist(self, command: HandTwist, seen: Observation, retreat: bool) -> HandTwist:
        side, twist = command.side, np.array(command.twist_in_map, float)
        twist *= self._ease(side, twist[:3], seen, retreat)
        hand = seen.pose_hand_in_map[SIDES.index(side), :3, 3]
        carried = self._carried(side, seen)
        speed = length(twist[:3])
        ahead = _ahead(hand, twist[:3], command.duration)
        near = bool((self.zone.distance(ahead) < self.limits.near_person + carried * command.duration).any())
        if near or self._grip[side] == "arm":
            limit = max(self._speed_limit(side) - carried, 0.0)
            if speed > limit:
                twist *= limit / speed
        if self._links is not None and self._clear is not None:
            twist = self._clear.twist(command, twist, seen, self._held)
            after = self._links.after_twist(seen, side, twist, command.duration)
            twist *= self._slow_links(seen, after, command.duration, carried)
        self._arm_moves(side, length(twist[:3]), command.duration)
        return replace(command, twist_in_map=twist)

    def _slow_links(self, seen: Observation, after: np.ndarray, duration: float, already: float = 0.0) -> float:
        """Share of a motion, after which the links are at `after` (r, 2, 3), that keeps those near the person slow."""
        assert self._links is not None
        if duration <= 0.0:
            return 1.0
        here, radii = self._links.ends(seen), self._links.radii
        speed = furthest_moved(here, after) / duration
        limit = max(self._near_limit() - already, 0.0)
        fast = speed > limit
        if not fast.any():
            return 1.0
        gap = np.minimum(*(self.zone.link_distance(ends[fast], radii[fast]) for ends in (here, after)))
        near = gap < self.limits.near_person + already * duration
        return limit / float(speed[fast][near].max()) if near.any() else 1.0

    def _slow_trajectory(self, command: JointTrajectory, seen: Observation, retreat: bool) -> JointTrajectory:
        factor, fastest = 1.0, {}
        for side in SIDES:
            index = SIDES.index(side)
            if self._hand_positions is None:
                if any(joint.startswith(f"{side}_") for joint in command.joints):
                    if np.linalg.norm(seen.wrench_hand_in_map[index, :3]) >= self._load_stop(side) and not retreat:
                        self._ease(side, -seen.wrench_hand_in_map[index, :3], seen, retreat)
                    speed = near_speed_bound(command, side, seen, self.zone, self.limits.near_person)
                    factor = max(factor, speed / self._speed_limit(side))
                    fastest[side] = self._speed_limit(side)
                continue
            walked = hand_path(self.robot, command, side, seen, self._hand_positions)
            if walked is None:
                continue
            times, path = walked
            assert self._links is not None  # where hands are known
            rows = self._links.rows(side)
            ease = self._ease(side, path[-1] - path[0], seen, retreat)
            carried = self._carried(side, seen)
            reach = self.limits.near_person + (BOTH_MOVE if carried > 0.0 else 0.0)
            _, ends = self._links.along(command, seen)
            speed = near_speed(times, ends[:, rows], self._links.radii[rows], self.zone, reach)
            steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
            fastest[side] = float((steps / np.maximum(np.diff(times), 1e-9)).max(initial=0.0))
            if self._grip[side] == "arm":
                speed = fastest[side]
                if np.linalg.norm(path - path[0], axis=1).max() > LIFT_MIN:
                    factor = max(factor, self.limits.lift_duration / max(float(times[-1]), 1e-9))
            limit = max(self._speed_limit(side) - carried, 1e-3)
            factor = max(factor, speed / limit, 1.0 / max(ease, 0.05))
        if self._clear is not None:
            self._clear.trajectory(command, seen, self._held)
        for side, speed in fastest.items():
            self._arm_moves(side, speed / factor, float(command.times[-1]) * factor)
        return stretched(command, factor) if factor > 1.0 else command

    def _arm_moves(self, side: Side, speed: float, duration: float) -> None:
        self._arm_until[side] = self.clock.now() + duration
        self._arm_speed[side] = speed

    def _slow_base(self, command: BaseVelocity, seen: Observation, retreat: bool) -> BaseVelocity:
        velocity, factor = np.array(command.velocity, float), 1.0
        x, y, yaw = seen.pose_base_in_map
        c, s = math.cos(yaw), math.sin(yaw)
        turn = np.array(((c, -s), (s, c)))
        hands = seen.pose_hand_in_map[:, :3, 3]
        for n, side in enumerate(SIDES):
            arm = hands[n, :2] - (x, y)
            planar = turn @ velocity[:2] + velocity[2] * np.array((-arm[1], arm[0]))
            motion = np.append(planar, 0.0)
            factor = min(factor, self._ease(side, motion, seen, retreat))
            speed = length(motion)
            ahead = _ahead(hands[n], motion, command.duration)
            own = self._arm_speed[side] if self.clock.now() < self._arm_until[side] else 0.0
            # an arm on its way was judged with the base at rest: moving both keeps further away
            reach = self.limits.near_person + (own * command.duration if own <= self._speed_limit(side) else BOTH_MOVE)
            near = bool((self.zone.distance(ahead) < reach).any())
            if speed > 0 and (near or self._grip[side] == "arm"):
                factor = min(factor, max(self._speed_limit(side) - own, 0.0) / speed)
        if self._links is not None and self._clear is not None:
            command = replace(command, velocity=factor * velocity)
            factor *= self._clear.base(command, seen, self._held)
            after = self._links.after_base(seen, factor * velocity, command.duration)
            factor *= self._slow_links(seen, after, command.duration)
        velocity *= factor
        self._base_until = self.clock.now() + command.duration
        self._base_speed = np.array((length(velocity[:2]), abs(velocity[2])))
        return replace(command, velocity=velocity)

    def _carried(self, side: Side, seen: Observation) -> float:
        """Speed that the moving base gives a hand now [m/s]."""
        if self.clock.now() >= self._base_until:
            return 0.0
        arm = seen.pose_hand_in_map[SIDES.index(side), :2, 3] - seen.pose_base_in_map[:2]
        return float(self._base_speed[0] + self._base_speed[1] * length(arm))

    def _soft_grip(self, command: GripperOpening, seen: Observation) -> GripperOpening:
        n = SIDES.index(command.side)
        if command.opening > seen.gripper_opening[n] + OPENED:
            self._grip[command.side] = "nothing"
        near = self.zone.distance(seen.pose_hand_in_map[n, :3, 3])[0] < self.limits.near_person
        if near or self._grip[command.side] == "arm":
            return replace(command, force_limit=min(command.force_limit, self.limits.grip_force_arm))
        return command


def _ahead(hand: np.ndarray, velocity: np.ndarray, duration: float) -> np.ndarray:
    """Where (5, 3) a hand passes that moves on like that."""
    return hand + (SHARES * duration)[:, None] * velocity
