"""A world on trial: what laws do to it, and how they say what is wrong."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..freshness import fresh_observation
from ..observation_form import ObservationForm
from ..scripted.clock import SteppedClock
from ..waiting import wait
from ..world import SIDES, Command, JointTrajectory, Observation, Side, World

PERIOD = 1.0 / 15.0  # [s] between two looks, as trees are ticked
STALE, FRAME_STALE = 0.5, 1.0  # [s] as the guard has it
STILL_JOINT, STILL_BASE = 0.02, 0.01  # [rad/s], [m/s and rad/s] slower stands still, as for the guard
STOPPED_WITHIN = 2.0  # [s] in which every motion can be stopped


class WorldLawBroken(AssertionError):  # noqa: N818 it states what is wrong, as assertions do
    """A world does not keep its contract; the message says which law, and how."""


@dataclass(frozen=True, kw_only=True)
class Breaks:
    """How to break a world on purpose, for laws that only show then; None where it cannot be done.

    Attributes:
        senses: joint states no longer come.
        clock: the clock stands still.
        emergency_stop: it is pressed.
    """

    senses: Callable[[World], object] | None = None
    clock: Callable[[World], object] | None = None
    emergency_stop: Callable[[World], object] | None = None


class WorldTrial:
    """A world that laws try.

    Args:
        world: to be tried.
        wall: the wall clock [s].

    Attributes:
        stepped: its time stands still until somebody waits.
        law: name of the one that is tried.
    """

    def __init__(self, world: World, wall: Callable[[], float] = time.perf_counter) -> None:
        self.world = world
        self.wall = wall
        self.stepped = isinstance(world.clock, SteppedClock)
        self.law = ""

    @property
    def joints(self) -> tuple[str, ...]:
        """Those of an arm, shoulder to wrist."""
        return self.world.robot.arm_joints

    def hold(self, holds: bool | np.bool_, sentence: str) -> None:
        """Say that the law is broken unless `holds`.

        Raises:
            WorldLawBroken: it is.
        """
        if not holds:
            raise WorldLawBroken(f"{type(self.world).__name__}: {self.law.replace('_', ' ')}: {sentence}")

    def now(self) -> float:
        """World clock [s]."""
        return self.world.clock.now()

    def observe(self) -> Observation:
        """The latest observation, if it is fresh; raises SensorLost."""
        return fresh_observation(self.world.observe(), self.now(), STALE, ObservationForm(self.world.robot))

    def let_pass(self, seconds: float) -> list[Observation]:
        """What is seen while `seconds` of world time pass, at least once at their end."""
        ends, seen = self.now() + seconds, []
        while self.now() < ends - 1e-6:
            wait(self.world.clock, min(self.now() + PERIOD, ends), wall=self.wall)
            seen.append(self.observe())
        return seen

    def rest(self) -> Observation:
        """Stop, and wait until nothing moves."""
        for _ in range(round(STOPPED_WITHIN / PERIOD)):
            self.world.stop()
            seen = self.let_pass(PERIOD)[-1]
            if is_still(seen):
                return seen
        self.hold(False, f"it does not come to rest within {STOPPED_WITHIN:g} s of stop()")
        raise AssertionError  # not reached

    def turn(self, side: Side, joint: str, angle: float, seconds: float) -> JointTrajectory:
        """Send a trajectory of one joint [rad] over `seconds`, the other way where a limit is near; what was sent."""
        start = float(self.observe().arm_positions[SIDES.index(side), self.joints.index(joint)])
        for goal in (start + angle, start - angle):
            command = joint_motion(f"{side}_{joint}", start, goal, seconds)
            sent = self.send(command)
            assert isinstance(sent, JointTrajectory)
            if abs(sent.positions[-1, 0] - goal) < 0.1 * abs(angle):
                return sent
        self.hold(False, f"{side}_{joint} can move {abs(angle):g} rad neither way, as what was sent says")
        raise AssertionError  # not reached

    def send(self, command: Command) -> Command:
        """Send a command; what was really sent is of the same kind and for the same joints, hand or base."""
        sent = self.world.send(command)
        kind = type(command).__name__
        self.hold(type(sent) is type(command), f"{kind} was sent, {type(sent).__name__} came back")
        for name in ("joints", "side"):
            same = getattr(sent, name, None) == getattr(command, name, None)
            self.hold(same, f"what came back for {kind} has other {name}")
        return sent


def is_still(seen: Observation) -> bool:
    """Whether neither arms nor base move."""
    return bool(np.abs(seen.arm_velocities).max() < STILL_JOINT and np.abs(seen.twist_base).max() < STILL_BASE)


def joint_motion(joint: str, start: float, goal: float, seconds: float) -> JointTrajectory:
    """A motion of one joint [rad] that begins and ends softly."""
    share = np.linspace(0.0, 1.0, 7)
    soft = share * share * (3.0 - 2.0 * share)
    return JointTrajectory(joints=(joint,), times=seconds * share, positions=(start + (goal - start) * soft)[:, None])
