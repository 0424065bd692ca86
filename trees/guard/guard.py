"""The guard: a world that keeps the limits, whoever commands it.

The runner wraps every world in it, so that a task author cannot leave it out.  It

- takes no trajectory that begins where the arm is not, and no velocity for long: what it judges is what happens;
- keeps every link slow near the person, and a hand that holds an arm slow and soft (`command_scaling.py`), and fails
  the skill where a link moves fast nevertheless (`overspeed.py`);
- keeps every link off the person and off the robot's other links (`keep_clear.py`);
- scales pulling down as the cloth load grows, stops at the limit, and then lets only relieving motion pass
  (`load_limit.py`);
- stops the run when the senses are stale, frozen or gone (`watchdog.py`), when the clock no longer says the time
  (`sure_clock.py`), or the emergency stop is pressed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from ...sim.abilities import HasKinematics
from ...sim.freshness import AHEAD, fresh_frame, fresh_observation
from ...sim.mechanics.kinematics import kinematics_of
from ...sim.observation_form import ObservationForm
from ...sim.world import (
    SIDES,
    BaseVelocity,
    Clock,
    Command,
    EmergencyStop,
    Frame,
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
from .command_scaling import CommandScaling
from .declared_grips import DeclaredGrips
from .joint_consistency import JointConsistency
from .limits import DEFAULT, Limits
from .link_motion import LinkMotion
from .load_limit import LoadLimit
from .motions_under_way import MotionsUnderWay
from .overspeed import Overspeed
from .sure_clock import SureClock
from .watchdog import Watchdog


class GuardedWorld:
    """A world behind the limits.  It passes on the contract and nothing else, so truth stays out of reach.

    Args:
        inner: the world.  Where it has no kinematics, those of its robot's model say where the links are.
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
        self._sure_clock = SureClock(inner.clock)
        self.clock: Clock = self._sure_clock
        self.room = inner.room
        self._inner = inner
        self.robot = inner.robot
        self._form = ObservationForm(inner.robot)
        self.zone = PersonZone(inner.room.bed, limits.person_above_bed)
        self._watchdog = Watchdog(limits)
        own = inner.kinematics if isinstance(inner, HasKinematics) else None
        kinematics = own or kinematics_of(inner.robot)
        links = LinkMotion(inner.robot, kinematics)
        self._consistency = JointConsistency(inner.robot, kinematics)
        self._grips = DeclaredGrips(self.zone)
        self._load = LoadLimit(limits)
        self._overspeed = Overspeed(limits, self.zone, links)
        self._under_way = MotionsUnderWay(self.clock)
        self._scaling = CommandScaling(
            links,
            limits=limits,
            zone=self.zone,
            load=self._load,
            grips=self._grips,
            under_way=self._under_way,
        )
        self._fault: Failure | None = None
        self._last: Observation | None = None
        self._judged_at = -np.inf  # world clock when it was [s]

    # -- what skills tell and ask ------------------------------------------------------------------------

    def update_person(self, points_in_map: np.ndarray, *, part: str = "person", radius: float = 0.06) -> None:
        """Say where a part of the person is: a chain of points (n, 3) and its radius [m]."""
        self.zone.update(points_in_map, part=part, radius=radius)

    def declare_grip(self, side: Side, what: Grip) -> None:
        """Say what a hand holds.  Which load is too high is told by how far its fingers stand apart, not by this."""
        self._grips.declare(side, what)
        self._grips.find_arm(side, self.observe().pose_hand_in_map[SIDES.index(side), :3, 3])

    @property
    def seen(self) -> Observation | None:
        """What was sensed last, for those who watch; None before anything was."""
        return self._last

    def held_arms(self) -> Mapping[Side, str]:
        """By hand, the person's arm that it holds, as the zone names it."""
        return self._grips.arms

    def grip(self, side: Side) -> Grip:
        """What a hand was said to hold."""
        return self._grips.of(side)

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
        moving = self._under_way.cut_short(since)
        if moving:
            self._fault = failure
        return moving

    def check(self) -> Failure | None:
        """Judge the state once per tick.

        Returns:
            What must stop the whole run (a dead clock, dead senses, the emergency stop), or None.  An excess of load
            or speed stops the motion at once and is held against the running skill instead.
        """
        self.clock.now()
        if self._sure_clock.fault:
            return Failure(Reason.WORLD_LOST, self._sure_clock.fault, "robot")
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
        """Latest proprioception, judged; raises SensorLost, also where it is too old or is none."""
        seen, now = self._inner.observe(), self.clock.now()
        if seen is self._last and now == self._judged_at:  # asked again at this very instant: it has been judged
            return seen
        seen = fresh_observation(seen, now, self.limits.stale_after, self._form)
        if self._last is not None and (back := self._last.time - seen.time) > AHEAD:
            raise SensorLost(f"the time of the joint state went back by {back:.1f} s")
        if fault := self._consistency.fault(seen):
            raise SensorLost(fault)
        self._watchdog.sample(seen, now)
        for fault in self._load.judge(seen):
            self._hold_against(fault)
        if self._last is None or seen.time > self._last.time:
            self._on_sample(seen)
            self._grips.carry(seen)
            if fault := self._overspeed.judge(seen, self._last):
                self._hold_against(fault)
        self._last, self._judged_at = seen, now
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
            SkillFailure: the load is at its limit and the motion does not relieve it; a trajectory begins where the
                arm is not.
        """
        seen = self.observe()
        if seen.emergency_stop:
            raise EmergencyStop("nothing moves before a person has released it")
        if isinstance(command, (HandTwist, BaseVelocity)) and command.duration > self.limits.velocity_for:
            command = replace(command, duration=self.limits.velocity_for)
        if isinstance(command, HandTwist):
            command = self._scaling.twist(command, seen, retreat)
        elif isinstance(command, JointTrajectory):
            self._begins_here(command, seen)
            command = self._scaling.trajectory(command, seen, retreat)
        elif isinstance(command, BaseVelocity):
            command = self._scaling.base(command, seen, retreat)
        else:
            command = self._scaling.grip(command, seen)
        self._before_command()
        sent = self._inner.send(command)
        self._under_way.begin()
        if self._on_command is not None:
            self._on_command(sent)
        return sent

    def _begins_here(self, command: JointTrajectory, seen: Observation) -> None:
        """Refuse a trajectory whose first point is elsewhere: how an arm would get there nobody has judged."""
        for joint, first in zip(command.joints, command.positions[0], strict=True):
            if (place := self.robot.place_of(joint)) is None:
                continue
            away = abs(float(first) - float(seen.arm_positions[place]))
            if away > self.limits.plan_start:
                allowed = f"{self.limits.plan_start:g} rad are allowed"
                raise SkillFailure(
                    Reason.MOTION_BLOCKED, f"the trajectory begins {away:.2f} rad from where {joint} is; {allowed}"
                )

    def stop(self) -> None:
        """End every motion now."""
        self._under_way.forget()
        self._inner.stop()

    def close(self) -> None:
        """Release what the world holds."""
        self._inner.close()

    def _hold_against(self, fault: Failure) -> None:
        """Stop the motion; the running skill takes the failure."""
        self.stop()
        self._fault = fault
