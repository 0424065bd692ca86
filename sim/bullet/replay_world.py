"""The dressing world, led once more through a stretch of a recorded run: what hands hold answers as the model has it.

The robot's joints go where they were measured; links touch the person, and hands take hold and let go, as in a run.
Motors, controllers and the tree are not simulated: they are all in the path that the joints really took.  Loads and
posture are then this world's answer to the motion that was made.

It is the same world down to the order of its bodies and where the hands are at first: the engine's solver stops after a
few iterations, and how the friction of an arm's joints shares a hand's load between them then depends on such things.
"""

from __future__ import annotations

import math
from contextlib import closing
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from ..effects.model_file import EffectModel
from ..mechanics.kinematics import Kinematics
from ..record.measured import Measured
from ..record.recorded_stretch import Stretch
from ..robot.body import JointReading
from ..world import SIDES, Command
from .coupled_room import CONTROL_STEPS, ROBOT_STEPS, TIME_STEP
from .gown_placement import put_arms
from .grip import Grip
from .sleep import SLEEP_TIME
from .world import SETTLE_RECORDED, BulletWorld

NEAR = 0.001  # arms that lie where they were recorded are not moved: friction forgets what it holds [m]
STILL = 2e-3  # a robot whose joints are slower stands [rad/s, m/s]
CALM = 1.0  # what it holds then comes to rest in this time [s]
CLOSING = 1.0  # the fingers were at their widest within this time before they took hold [s]
EARLY = 0.2  # fingers may meet what they hold this long before the record has them hold it [s]
DRAGGING = 0.3  # in which fingers that have taken hold pull an arm to themselves [s]


@dataclass(frozen=True, kw_only=True, eq=False)
class Answer:
    """What the model has at the samples: (T, 2, 3) load on each hand in the map [N], (T, 2, 4, 3) arms [m]."""

    load: np.ndarray
    arms: np.ndarray


def replayed(stretch: Stretch, model: EffectModel | None = None, drag: float = 0.0) -> Answer:
    """What the dressing world, with the effects of a model for it, has in a stretch.

    Args:
        stretch: of a record.
        model: effects on the world.
        drag: how far the closing fingers pull the arm along their closing axis as they take hold, beside what the
            model has of it [m].  It differs from grip to grip, and strains the arm's joints until they slip.

    Raises:
        CaretreeError: the model cannot be loaded into this world.
    """
    with closing(ReplayWorld(stretch, model, drag)) as world:
        return world.follow()


class ReplayWorld(BulletWorld):
    """A dressing world whose robot is led along a record.

    Args:
        stretch: of the record.
        model: effects on it.
        drag: of the hand whose load is looked at, see `replayed` [m].
    """

    def __init__(self, stretch: Stretch, model: EffectModel | None = None, drag: float = 0.0) -> None:
        self._stretch, self._places = stretch, _Places(stretch.robot)
        self._drag, self._taken = drag, math.inf  # when that hand took hold [s]
        self._start = float(stretch.robot.t[0])
        super().__init__(
            seed=stretch.scene.seed,
            gown=stretch.gown,
            person=stretch.person,
            kind=stretch.scene.kind.name,
            model=model,
        )
        for _ in range(round(SLEEP_TIME / TIME_STEP) + CONTROL_STEPS):  # arms lie a while before they sleep
            self._step()
        put_arms(self._person, stretch.arms, unless_within=NEAR)
        if stretch.vertices is not None:
            self._take_off_hook()
            self._cloth.place(stretch.vertices)
            self._settle(SETTLE_RECORDED)
            self._tell_where_it_lies()
            self._wake()
        self._steps = round(self._start / TIME_STEP) // CONTROL_STEPS * CONTROL_STEPS
        self.time.time = self._steps * TIME_STEP
        self._contact.forget()

    def follow(self) -> Answer:
        """Lead the robot to the end of the stretch."""
        t, still = self._stretch.robot.t, _still(self._stretch.robot)
        loads, arms = np.zeros((len(t), 2, 3)), np.zeros((len(t), 2, 4, 3))
        row = 0
        while row < len(t):
            if t[row] <= self.time.time + TIME_STEP / 2:
                loads[row] = [grip.load for grip in self._grips] + self._contact.wrench(self._hands)[:, :3]
                arms[row] = self._person.arms()
                row += 1
            elif (
                still[row] and still[row - 1]
            ):  # nothing changes: on to the next sample, at the same place in the cycle
                cycles = max(1, int((t[row] - self.time.time) / TIME_STEP / CONTROL_STEPS))
                self._steps += cycles * CONTROL_STEPS
                self.time.time = self._steps * TIME_STEP
            else:
                self._step()
        return Answer(load=loads, arms=arms)

    def _stand(self, pose_base_in_map: tuple[float, float, float], **posture: Any) -> Any:
        """In the place of a robot: one that is led."""
        reading = replace(
            self._places.at(self._start), arm_positions=self.robot.ready, pose_base_in_map=np.array(pose_base_in_map)
        )
        self._led = _LedRobot(self.kinematics, reading)
        return self._led

    def _settle(self, duration: float) -> None:
        if self._stretch.vertices is None and self._cloth.body >= 0:  # the gown plays no part
            self.remove_gown()
        super()._settle(duration)

    def _step_robot(self) -> None:
        self._meet()
        time = self.time.time + ROBOT_STEPS * TIME_STEP
        self._led.reading = self._reading = reading = self._places.at(time)
        self._contact.watch(time, reading)
        self._hands = self._led.poses_hands_in_map(reading)
        if self._drag:
            self._pull_aside()

    def _pull_aside(self) -> None:
        """A hand that is aside of where it was as it takes hold, and then comes there, drags what it holds along."""
        n, now = self._stretch.hand, self.time.time
        if self._grips[n].kind == "arm":
            self._taken = min(self._taken, now)
        left = 1.0 - min(max((now - self._taken) / DRAGGING, 0.0), 1.0)
        self._hands[n, :3, 3] -= left * self._drag * self._hands[n, :3, 1]

    def _update_fingers(self, reading: JointReading) -> None:
        """Let the fingers close and open when they did."""
        held, t, now = self._stretch.held, self._stretch.robot.t, self.time.time
        row, soon = (max(0, int(np.searchsorted(t, x + TIME_STEP / 2)) - 1) for x in (now, now + EARLY))
        for n, grip in enumerate(self._grips):
            holds = [held.part[k, n] >= 0 or held.cloth[k, n] for k in (row, soon)]
            if grip.kind == "nothing" and holds[1]:
                spell = (t > now - CLOSING) & (t <= now + EARLY)
                widest = float(self._stretch.robot.gripper_opening[spell, n].max(initial=0.0))
                grip.on_command(0.0, max(widest, float(reading.gripper_opening[n])))
            elif grip.kind != "nothing" and not any(holds):
                grip.release()
        super()._update_fingers(reading)

    def _catches(self, grip: Grip, hand: np.ndarray, opening: float, force: float) -> bool:
        """The part of an arm that was held, as the hand may be over a joint between two."""
        t = self._stretch.robot.t
        soon = max(0, int(np.searchsorted(t, self.time.time + EARLY + TIME_STEP / 2)) - 1)
        part = int(self._stretch.held.part[soon, SIDES.index(grip.side)])
        return part >= 0 and grip.catch_arm(hand, opening, force, part)


class _LedRobot:
    """What the world asks of its robot, answered from a record."""

    def __init__(self, kinematics: Kinematics, reading: JointReading) -> None:
        self._kinematics, self.reading = kinematics, reading

    @property
    def servo(self) -> JointReading:
        """Where its motors are sent: where it is."""
        return self.reading

    def read(self) -> JointReading:
        """The joints."""
        return self.reading

    def poses_hands_in_map(self, reading: JointReading | None = None) -> np.ndarray:
        """Poses (2, 4, 4) of both hands."""
        reading = reading or self.reading
        return self._kinematics.poses_hands_in_map(reading.arm_positions, reading.pose_base_in_map)

    def command(self, command: Command) -> Command:
        """It is led, whatever it is told."""
        return command


def _still(robot: Measured) -> np.ndarray:
    """(T,) samples around which the robot has stood still for a while: what it holds has come to rest."""
    together = np.column_stack((robot.arm_positions.reshape(len(robot.t), -1), robot.pose_base, robot.gripper_opening))
    moves = np.abs(np.diff(together, axis=0)).max(axis=1) > STILL * np.diff(robot.t)
    last = np.concatenate(([robot.t[0]], np.maximum.accumulate(np.where(moves, robot.t[1:], robot.t[0]))))
    after = np.append(np.minimum.accumulate(np.where(moves, robot.t[:-1], np.inf)[::-1])[::-1], np.inf)
    return (robot.t - last > CALM) & (after - robot.t > CALM / 2)


class _Places:
    """Where the robot was at any time, smooth between samples."""

    def __init__(self, robot: Measured) -> None:
        rows = len(robot.t)
        self._shape = robot.arm_positions.shape[1:]
        together = np.column_stack((robot.arm_positions.reshape(rows, -1), robot.head_pan, robot.pose_base))
        # between two steps of the simulated robot, its sensors already say where the step under way will have led
        step = ROBOT_STEPS * TIME_STEP
        self._smooth = CubicSpline(np.ceil(robot.t / step - 1e-6) * step, together)
        self._t, self._opening = robot.t, robot.gripper_opening

    def at(self, time: float) -> JointReading:
        """The joints; speeds and efforts, which nobody asks for, are zero."""
        time = min(max(time, self._t[0]), self._t[-1])
        x = self._smooth(time)
        q, nothing = x[:-4].reshape(self._shape), np.zeros(self._shape)
        return JointReading(
            arm_positions=q,
            arm_velocities=nothing,
            motor_torques=nothing,
            head_pan=float(x[-4]),
            pose_base_in_map=x[-3:],
            twist_base=np.zeros(3),
            gripper_opening=np.array([np.interp(time, self._t, opening) for opening in self._opening.T]),
            gripper_force=np.zeros(len(SIDES)),
        )
