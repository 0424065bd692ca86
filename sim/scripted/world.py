"""A world of numbers: arms go where they are sent, fingers close, and an hour passes in milliseconds.

Where its kinematics know the limits of joints, hands follow twists by the law that the simulated room and a robot
behind a master have, and no joint turns further or faster than it can.

It has no cloth and no images of its own.  Tests and task authors script what matters: frames by a function,
loads and what is between the fingers by attributes, and what is seen by scripted senses.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..compiled import njit
from ..mechanics.joint_limits import JointLimits
from ..mechanics.kinematics import Kinematics
from ..mechanics.robot_model import RobotModel
from ..mechanics.servo import PERIOD
from ..mechanics.twist import TwistTracker
from ..robot.baxter import BAXTER
from ..scene.objects import ObjectError, RoomObject
from ..world import (
    CAMERAS,
    SIDES,
    BaseVelocity,
    Command,
    Frame,
    GripperOpening,
    HandTwist,
    JointTrajectory,
    Observation,
    RoomMap,
    SensorLost,
    Side,
    World,
)
from .clock import SteppedClock
from .exact_twist import ExactTwist
from .linear_arm import LinearArms

STEP = 0.02  # [s] longest step of the integration
FINGER_SPEED = 0.1  # [m/s]
WRENCH_NOISE = 0.01  # [N], [N m] standard deviation: a silent force sensor would be a dead one
DEPTH_NOISE = 0.001  # [m]
# Every camera looks straight down from above the middle of the bed, whose mattress is all that shows.
FROM_ABOVE = np.array(((1.0, 0.0, 0.0, 0.0), (0.0, -1.0, 0.0, 0.0), (0.0, 0.0, -1.0, 2.2), (0.0, 0.0, 0.0, 1.0)))


def _nothing() -> None:
    pass


def scripted_room() -> RoomMap:
    """A free room of 8 m by 8 m with a bed in the middle."""
    free = np.ones((80, 80), dtype=bool)
    free[28:52, 34:46] = False
    waypoints = {
        "start": (2.5, -2.5, 1.57),
        "rail": (2.5, 2.5, 1.57),
        "bed_right": (1.2, 0.0, 3.14),
        "bed_left": (-1.2, 0.0, 0.0),
    }
    return RoomMap(
        free=free,
        origin=np.array((-4.0, -4.0)),
        resolution=0.1,
        waypoints=waypoints,
        bed=np.array(((-0.45, -1.0, 0.0), (0.45, 1.0, 0.7))),
    )


@dataclass
class _Motion:
    """One trajectory under way."""

    start: float
    times: np.ndarray
    positions: np.ndarray  # (k, n)
    slots: list[tuple[int, int]] = field(default_factory=list)  # per column: arm and joint, or (-1, 0) for the head

    def __post_init__(self) -> None:
        self.columns = [n for n, (arm, _) in enumerate(self.slots) if arm >= 0]  # those of arms
        self.arms, self.joints = [self.slots[n][0] for n in self.columns], [self.slots[n][1] for n in self.columns]
        self.head = next((n for n, (arm, _) in enumerate(self.slots) if arm < 0), None)  # column of the head

    def at(self, time: float) -> np.ndarray:
        """(n,) positions at a time since its start [s], straight between the samples."""
        n = int(self.times.searchsorted(time, "right")) - 1
        if n < 0 or n == len(self.times) - 1:
            return self.positions[max(n, 0)]
        first, last = self.positions[n], self.positions[n + 1]
        return (last - first) / (self.times[n + 1] - self.times[n]) * (time - self.times[n]) + first


class ScriptedWorld(World):
    """The contract without physics.

    Args:
        seed: of the sensor noise.
        frames: `(camera, time) -> Frame`; flat grey pictures by default.
        room: map; `scripted_room()` by default.
        robot: that skills plan with; Baxter by default.
        kinematics: what moves the hands: the robot's own where planned motions shall end where they should, and joints
            at their limits; by default linear arms, which have none.
        arm_positions: (2, n) where the arms are at first [rad]; zeros by default.
        stopping_time: how long arms and base run on after a stop, slowing down evenly [s].

    Attributes:
        time: the clock, whose `time` may be set.
        load: side -> force and torque (6,) on that hand in the map frame [N], [N m]; set it at will.
        between_fingers: side -> thickness of what the fingers meet when they close [m]; 0 for nothing.
        sent: every command, in order.
        objects: what a task has added, by name; here they only stand in the record of it.
        has_gown: whether a task has left the gown in the room.
    """

    def __init__(
        self,
        *,
        seed: int = 0,
        frames: Callable[[str, float], Frame] | None = None,
        room: RoomMap | None = None,
        robot: RobotModel = BAXTER,
        kinematics: Any = None,
        stopping_time: float = 0.15,
        arm_positions: np.ndarray | None = None,
    ) -> None:
        self.time = SteppedClock(self._advance_to)
        self.clock = self.time
        self.room = room or scripted_room()
        self.robot = robot
        self.kinematics: Any = kinematics or LinearArms()
        shape = (2, robot.dof)
        self.load: dict[Side, np.ndarray] = {side: np.zeros(6) for side in SIDES}
        self.between_fingers: dict[Side, float] = {"left": 0.0, "right": 0.0}
        self._person_offset, self._person_asked = np.zeros(3), _nothing
        self.sent: list[Command] = []
        self.objects: dict[str, RoomObject] = {}
        self.has_gown = True
        self._rng = np.random.default_rng(seed)
        self._frames = frames or self._flat_frame
        limited = isinstance(self.kinematics, Kinematics)
        self._limits = JointLimits.of(self.kinematics) if limited else JointLimits.none(robot)
        self._unlimited = self._limits.unlimited
        self._lower, self._upper, self._speed = self._limits.of_arms()
        start = np.zeros(shape) if arm_positions is None else np.array(arm_positions, float).reshape(shape)
        self._q = np.clip(start, self._lower, self._upper)
        self._dq = np.zeros(shape)
        self._head = 0.0
        self._base = np.array(self.room.waypoints.get("start", (0.0, 0.0, 0.0)), float)
        self._base_velocity, self._base_until = np.zeros(3), 0.0
        self._twists: dict[Side, Any] = {
            side: (TwistTracker if limited else ExactTwist)(self.kinematics, side) for side in SIDES
        }
        self._twist_step = PERIOD if limited else np.inf  # [s] for which a tracker's joint rates hold
        self._motions: list[_Motion] = []
        self._rates: dict[int, tuple[np.ndarray, float]] = {}  # of an arm's joints, and until when
        self._longest_step = STEP
        self._stopping_time = stopping_time
        self._coast_start, self._coast_q, self._coast_base = -np.inf, np.zeros(shape), np.zeros(3)
        self._opening = np.full(2, robot.gripper.stroke)
        self._opening_goal = np.full(2, robot.gripper.stroke)
        self._force_limit = np.zeros(2)
        self._posed, self._poses = b"", np.zeros((2, 4, 4))

    # -- what a task brings along ------------------------------------------------------------------------

    def add(self, item: RoomObject) -> None:
        """Remember an object; raises ObjectError for a name that is taken."""
        if item.name in self.objects:
            raise ObjectError(f"there is an object {item.name!r} already")
        self.objects[item.name] = item

    def remove_gown(self) -> None:
        """Remember that there is no gown."""
        self.has_gown = False

    # -- senses ------------------------------------------------------------------------------------------

    def observe(self) -> Observation:
        """Exact joints, noisy wrenches."""
        now = self.clock.now()
        wrench = WRENCH_NOISE * self._rng.standard_normal((2, 6))
        squeezing = self._force_limit.copy()
        for n, (side, opening) in enumerate(zip(SIDES, self._opening.tolist(), strict=True)):
            wrench[n] += self.load[side]
            if not self.between_fingers[side] + 1e-6 >= opening > 1e-6:
                squeezing[n] = 0.0
        return Observation(
            time=now,
            arm_positions=self._q.copy(),
            arm_velocities=self._dq.copy(),
            arm_efforts=np.zeros(self._q.shape),
            head_pan=self._head,
            pose_base_in_map=self._base.copy(),
            twist_base=self._twist_base(now).copy(),
            gripper_opening=self._opening.copy(),
            gripper_force=squeezing,
            wrench_hand_in_map=wrench,
            pose_hand_in_map=self._hand_poses().copy(),
        )

    def _hand_poses(self) -> np.ndarray:
        """Poses (2, 4, 4) of both hands in the map, kept as long as nothing has moved: many ask within one tick."""
        stands = self._q.tobytes() + self._base.tobytes()
        if stands != self._posed:
            place = self.kinematics.pose_hand_in_map
            if isinstance(self.kinematics, Kinematics):
                self._poses = self.kinematics.poses_hands_in_map(self._q, self._base)
            else:
                self._poses = np.array([place(side, self._q[n], self._base) for n, side in enumerate(SIDES)])
            self._posed = stands
        return self._poses

    def look(self, camera: str) -> Frame:
        """What the script shows; raises SensorLost for an unknown camera."""
        if camera not in CAMERAS:
            raise SensorLost(f"there is no camera {camera!r}; there are {', '.join(CAMERAS)}")
        return self._frames(camera, self.clock.now())

    def _flat_frame(self, camera: str, time: float) -> Frame:
        depth = 1.5 + DEPTH_NOISE * self._rng.standard_normal((24, 32))
        return Frame(
            camera=camera,
            stamp=time,
            rgb=np.full((24, 32, 3), 128, np.uint8),
            depth=depth.astype(np.float32),
            intrinsics=(30.0, 30.0, 16.0, 12.0),
            pose_camera_in_map=FROM_ABOVE,
        )

    # -- motions -----------------------------------------------------------------------------------------

    def send(self, command: Command) -> Command:
        """Start a motion; returns it within the limits of fingers and joints.

        Raises:
            WorldError: the robot does not have one of the joints.
        """
        now = self.clock.now()
        if isinstance(command, JointTrajectory):
            command.check_joints(self.robot)
            command = command if self._unlimited else self._limits.trajectory(command)[0]
            motion = self._motion(command, now)
            self._drop(set(motion.slots))
            self._motions.append(motion)
            for arm in {arm for arm, _ in motion.slots if arm >= 0}:
                self._end_coasting(arm)
            for n, side in enumerate(SIDES):
                if any(arm == n for arm, _ in motion.slots):
                    self._twists[side].cancel()
                    self._rates.pop(n, None)
        elif isinstance(command, HandTwist):
            self._drop({(SIDES.index(command.side), joint) for joint in range(self.robot.dof)})
            self._end_coasting(SIDES.index(command.side))
            self._rates.pop(SIDES.index(command.side), None)
            command = self._twists[command.side].start(command, now)
        elif isinstance(command, BaseVelocity):
            self._end_coasting(-1)
            self._base_velocity, self._base_until = np.array(command.velocity, float), now + command.duration
        elif isinstance(command, GripperOpening):
            n = SIDES.index(command.side)
            command = replace(command, opening=min(command.opening, self.robot.gripper.stroke))
            self._opening_goal[n] = command.opening
            self._force_limit[n] = command.force_limit
        self.sent.append(command)
        return command

    def send_joint_velocities(self, side: Side, velocities: np.ndarray, duration: float) -> None:
        """Move an arm joint by joint (7,) [rad/s] for `duration` [s]: for drivers, no part of the contract."""
        arm = SIDES.index(side)
        self._drop({(arm, joint) for joint in range(7)})
        self._twists[side].cancel()
        self._end_coasting(arm)
        rates = np.clip(np.array(velocities, float), -self._speed[arm], self._speed[arm])
        self._rates[arm] = rates, self.clock.now() + duration

    def stop(self) -> None:
        """End every motion, which takes the stopping time; the fingers go on holding."""
        now = self.clock.now()
        driving = now < self._base_until
        if self._motions or self._twisting() or self._rates or driving:
            self._coast_start, self._coast_q = now, self._dq.copy()
            self._coast_base = self._base_velocity.copy() if driving else np.zeros(3)
        self._motions.clear()
        for twist in self._twists.values():
            twist.cancel()
        self._rates.clear()
        self._base_until = now

    def _slowing(self, time: float) -> float:
        """Fraction of the speed that is left at `time` after a stop."""
        if self._stopping_time <= 0.0:
            return 0.0
        left = 1.0 - (time - self._coast_start) / self._stopping_time
        return 0.0 if left <= 0.0 else min(left, 1.0)

    def _end_coasting(self, arm: int) -> None:
        """A new command takes an arm over (-1: the base)."""
        if arm < 0:
            self._coast_base = np.zeros(3)
        else:
            self._coast_q[arm] = 0.0

    def _motion(self, command: JointTrajectory, now: float) -> _Motion:
        slots = [self.robot.place_of(joint) or (-1, 0) for joint in command.joints]
        return _Motion(now, np.asarray(command.times, float), np.asarray(command.positions, float), slots)

    def _drop(self, slots: set[tuple[int, int]]) -> None:
        """Forget motions that use any of these joints."""
        self._motions = [motion for motion in self._motions if not slots & set(motion.slots)]

    def _advance_to(self, time: float) -> None:
        while self.time.time < time - 1e-9:
            if self._rests():
                self._dq[:] = 0.0
                break
            longest = min(self._longest_step, self._twist_step) if self._twisting() else self._longest_step
            self._step(min(longest, time - self.time.time))
        self.time.time = max(self.time.time, time)  # without the rounding of the sum

    def _rests(self) -> bool:
        """Whether nothing moves until the next command, however much time passes."""
        now = self.time.time
        if self._motions or self._twisting() or self._rates or now < self._base_until or self._slowing(now) > 0.0:
            return False
        return self._opening.tolist() == self._fingers_goal()

    def _twisting(self) -> bool:
        return self._twists["left"].active or self._twists["right"].active

    def _twist_base(self, time: float) -> np.ndarray:
        """Velocity (3,) of the base in its own frame [m/s, m/s, rad/s]."""
        return self._base_velocity if time < self._base_until else self._coast_base * self._slowing(time)

    def _fingers_goal(self) -> list[float]:
        """Opening (2,) at which each hand's fingers end [m]."""
        wanted = self._opening_goal.tolist()
        return [max(wanted[n], self.between_fingers[side]) for n, side in enumerate(SIDES)]

    def _step(self, dt: float) -> None:
        now = self.time.time + dt
        before = self._q.copy()
        for motion in tuple(self._motions):
            values = motion.at(now - motion.start)
            self._q[motion.arms, motion.joints] = values[motion.columns]
            if motion.head is not None:
                self._head = float(values[motion.head])
            if now - motion.start > motion.times[-1] + dt:
                self._motions.remove(motion)
        for arm, twist in enumerate(self._twists.values()):
            if not twist.active:
                continue
            turns = twist.rates(now, self._q[arm], self._dq[arm], self._base, self._twist_base(self.time.time))
            if turns is not None:
                self._q[arm] += turns * dt
        for arm, (rates, until) in tuple(self._rates.items()):
            moved = min(until, now) - self.time.time
            if moved <= 1e-9:
                del self._rates[arm]
                continue
            self._q[arm] += rates * moved
        left = self._slowing(now)
        if left > 0.0:
            self._q += self._coast_q * left * dt
        _limit(self._q, before, self._lower, self._upper, dt, self._dq)
        driven = max(min(self._base_until, now) - self.time.time, 0.0)
        if left > 0.0 or driven > 0.0:
            self._drive(driven * self._base_velocity + dt * left * self._coast_base)
        goal = self._fingers_goal()
        if self._opening.tolist() != goal:
            self._opening += np.clip(goal - self._opening, -FINGER_SPEED * dt, FINGER_SPEED * dt)
        self.time.time = now

    def _drive(self, way: np.ndarray) -> None:
        """Move the base by a way (3,) in its own frame [m, m, rad]."""
        vx, vy, turn = way.tolist()
        yaw = float(self._base[2])
        c, s = math.cos(yaw), math.sin(yaw)
        self._base += np.array((c * vx - s * vy, s * vx + c * vy, turn))

    # -- the person --------------------------------------------------------------------------------------

    @property
    def person_offset(self) -> np.ndarray:
        """How far the person has moved (3,) [m]; tests and estimators may read it."""
        self._person_asked()
        return self._person_offset

    @person_offset.setter
    def person_offset(self, offset: np.ndarray) -> None:
        """Have the person moved so far."""
        self._person_offset = offset

    def tell_of_person(self, asked: Callable[[], None]) -> bool:
        """Call `asked` before each look at `person_offset`; False for a class that has its people move otherwise."""
        self._person_asked = asked
        return type(self).fault_move_person is ScriptedWorld.fault_move_person

    # -- effects of faults -------------------------------------------------------------------------------

    def fault_grip_slip(self, side: Side) -> None:
        """Whatever that hand held is gone."""
        self.between_fingers[side] = 0.0
        self.load[side] = np.zeros(6)

    def slip_changes_nothing(self, side: Side) -> bool:
        """Whether there is neither anything between the fingers nor a load."""
        usual = type(self).fault_grip_slip is ScriptedWorld.fault_grip_slip
        return usual and self.between_fingers[side] == 0.0 and not self.load[side].any()

    def fault_move_person(self) -> None:
        """The person shifts by 10 cm."""
        self._person_offset = self._person_offset + np.array((0.1, 0.0, 0.0))


@njit()
def _limit(
    q: np.ndarray, before: np.ndarray, lower: np.ndarray, upper: np.ndarray, dt: float, rates: np.ndarray
) -> None:
    """Keep angles (2, n) within their limits, and note at which rates (2, n) a step has brought them there."""
    for arm in range(len(q)):
        for joint in range(q.shape[1]):
            if q[arm, joint] < lower[arm, joint]:
                q[arm, joint] = lower[arm, joint]
            elif q[arm, joint] > upper[arm, joint]:
                q[arm, joint] = upper[arm, joint]
            rates[arm, joint] = (q[arm, joint] - before[arm, joint]) / dt
