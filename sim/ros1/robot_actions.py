"""The actions of a simulated robot: trajectories of the arms, the head, and the fingers."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..robot.model import HEAD_JOINT, arm_joints
from ..world import SIDES, GripperOpening, JointTrajectory, Side, World, WorldError
from .messages import message
from .ros import ros
from .site import Site

FINGERS = 2.0  # [s] after which fingers have come where they come
SHORTEST = 0.05  # [s] of a turn of the head


@dataclass
class _Goal:
    """A goal under way."""

    handle: Any
    ends: float  # world clock [s]
    kind: str


class RobotActions:
    """Takes goals and ends them.

    Args:
        site: names the actions.
        world: what moves first.
        lock: held while the world is used, and by whoever tells of goals.
        why_not: says why nothing may move; empty where it may.

    Attributes:
        world: what moves.
    """

    def __init__(self, site: Site, world: World, lock: Any, why_not: Callable[[], str]) -> None:
        ros()
        server = importlib.import_module("actionlib").ActionServer
        self._site, self.world, self._lock, self._why_not = site, world, lock, why_not
        self._goals: dict[str, _Goal] = {}

        def serve(name: str, kind: str, start: Callable[[Any], float], key: str, cancelled: Callable[[], None]) -> None:
            def take(handle: Any) -> None:
                self._take(handle, kind, key, start)

            def cancel(handle: Any) -> None:
                self._cancel(handle, key, cancelled)

            served = server(name, message(f"control_msgs/{kind}Action"), take, cancel, auto_start=False)
            # the server's own lock would be taken before the robot's where a goal comes, and after it where one ends
            served.lock = lock
            served.start()

        for side in SIDES:
            serve(
                site.arms[side].trajectory,
                "FollowJointTrajectory",
                lambda goal, side=side: self._follow(side, goal),
                side,
                lambda side=side: self._hold(side),
            )
            serve(
                site.grippers[side].action,
                "GripperCommand",
                lambda goal, side=side: self._grip(side, goal),
                f"{side} gripper",
                lambda: None,
            )
        serve(site.head.action, "SingleJointPosition", self._turn_head, "head", self._hold_head)

    def finish(self, now: float) -> None:
        """Say of every goal whose time is over that it is reached."""
        for key, goal in list(self._goals.items()):
            if now >= goal.ends:
                del self._goals[key]
                goal.handle.set_succeeded(message(f"control_msgs/{goal.kind}Result")())

    def forget(self, key: str) -> None:
        """Something else moves what a goal was moving."""
        goal = self._goals.pop(key, None)
        if goal is not None:
            goal.handle.set_aborted(None, "replaced by another command")

    def abort(self, *, fingers: bool = False) -> None:
        """End all goals, the fingers' only if asked to."""
        for key in list(self._goals) if fingers else (*SIDES, "head"):
            self.forget(key)

    def _take(self, handle: Any, kind: str, key: str, start: Callable[[Any], float]) -> None:
        with self._lock:
            if why := self._why_not():
                handle.set_rejected(None, why)
                return
            try:
                lasts = start(handle.get_goal())
            except (WorldError, KeyError, ValueError) as error:
                handle.set_rejected(None, str(error))
                return
            self.forget(key)
            handle.set_accepted()
            self._goals[key] = _Goal(handle, self.world.clock.now() + lasts, kind)

    def _cancel(self, handle: Any, key: str, cancelled: Callable[[], None]) -> None:
        with self._lock:
            goal = self._goals.get(key)
            if goal is not None and goal.handle == handle:
                del self._goals[key]
                cancelled()
            handle.set_canceled()

    def _follow(self, side: Side, goal: Any) -> float:
        names, points = list(goal.trajectory.joint_names), goal.trajectory.points
        arm = self._site.arms[side]
        if set(names) != set(arm.joints):
            raise WorldError(f"a trajectory of the {side} arm names {', '.join(names)}")
        order = [arm.joints.index(name) for name in names]
        positions = np.array([point.positions for point in points]) - np.array(arm.zero)[order]
        times = np.array([point.time_from_start.to_sec() for point in points])
        if len(times) and times[0] > 0.0:
            here = self.world.observe().arm_positions[SIDES.index(side)][order]
            times, positions = np.append(0.0, times), np.vstack((here, positions))
        joints = tuple(arm_joints(side)[n] for n in order)
        self.world.send(JointTrajectory(joints=joints, times=times, positions=positions))
        return float(times[-1])

    def _turn_head(self, goal: Any) -> float:
        here = self.world.observe().head_pan
        speed = min(goal.max_velocity or np.inf, self._site.head.speed)
        lasts = max(goal.min_duration.to_sec(), 1.5 * abs(goal.position - here) / speed, SHORTEST)
        self._send_head(here, goal.position, lasts)
        return lasts

    def _send_head(self, here: float, there: float, lasts: float) -> None:
        share = np.linspace(0.0, 1.0, 7)
        path = here + (there - here) * share * share * (3.0 - 2.0 * share)
        self.world.send(JointTrajectory(joints=(HEAD_JOINT,), times=lasts * share, positions=path[:, None]))

    def _grip(self, side: Side, goal: Any) -> float:
        command = goal.command
        self.world.send(GripperOpening(side=side, opening=max(command.position, 0.0), force_limit=command.max_effort))
        return FINGERS

    def _hold(self, side: Side) -> None:
        moved: Any = self.world
        moved.send_joint_velocities(side, np.zeros(len(self._site.arms[side].joints)), 0.2)

    def _hold_head(self) -> None:
        here = self.world.observe().head_pan
        self._send_head(here, here, SHORTEST)
