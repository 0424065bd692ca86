"""A client of one action: stamps of goals always grow, so a stop reaches what was sent before it and nothing else."""

from __future__ import annotations

import threading
import time
from typing import Any

from ..world import WorldError
from .messages import message
from .ros import ros

TAKEN = 0.1  # [s] of wall time in which a server says that it has a goal
REFUSED = (5,)  # GoalStatus REJECTED
TICK = 1000  # [ns] between two stamps


class Stamps:
    """Stamps for goals and cancellations, each later than the one before, whatever the clock does."""

    def __init__(self, now: Any) -> None:
        self._now, self._last, self._lock = now, 0, threading.Lock()

    def next(self) -> Any:
        """The next one."""
        with self._lock:
            self._last = max(self._last + TICK, int(self._now() * 1e9))
            return ros().genpy.Time(0, self._last)


class ActionClient:
    """Sends goals and waits a moment until each is taken.

    Args:
        rospy: the node.
        name: of the action.
        kind: such as `control_msgs/FollowJointTrajectory`.
        stamps: shared by all actions of a robot.
    """

    def __init__(self, rospy: Any, name: str, kind: str, stamps: Stamps) -> None:
        there = ros()
        self.name, self._stamps = name, stamps
        self._kind, self._goal_kind = message(f"{kind}ActionGoal"), message(f"{kind}Goal")
        self._goals = rospy.Publisher(f"{name}/goal", self._kind, queue_size=10, tcp_nodelay=True)
        self._cancels = rospy.Publisher(f"{name}/cancel", there.actionlib_msgs.GoalID, queue_size=10, tcp_nodelay=True)
        self._changed = threading.Condition()
        self._states: dict[str, tuple[int, str]] = {}
        self._status = rospy.Subscriber(
            f"{name}/status", there.actionlib_msgs.GoalStatusArray, self._heard, tcp_nodelay=True
        )
        self._count = 0

    def connected(self) -> bool:
        """Whether somebody takes goals and cancellations, and tells of them."""
        return bool(
            self._goals.get_num_connections()
            and self._cancels.get_num_connections()
            and self._status.get_num_connections()
        )

    def goal(self, **values: Any) -> Any:
        """A goal that has not been sent, with its stamp."""
        goal = self._kind(goal=self._goal_kind(**values))
        goal.header.stamp = goal.goal_id.stamp = self._stamps.next()
        self._count += 1
        goal.goal_id.id = f"caretree-{id(self)}-{self._count}-{goal.goal_id.stamp.to_nsec()}"
        return goal

    def send(self, goal: Any) -> None:
        """Send it.

        Raises:
            WorldError: nobody takes it, or it is refused.
        """
        if not self._goals.get_num_connections():
            raise WorldError(f"nobody takes goals at {self.name}")
        self._goals.publish(goal)

    def wait_taken(self, goal: Any) -> None:
        """Wait until the server says that it has the goal, or the moment is over: a lost command shows by itself.

        Raises:
            WorldError: it is refused.
        """
        name, ends = goal.goal_id.id, time.monotonic() + TAKEN
        with self._changed:
            while name not in self._states and (left := ends - time.monotonic()) > 0.0:
                self._changed.wait(left)
            state, said = self._states.get(name, (0, ""))
        if state in REFUSED:
            raise WorldError(f"{self.name} refuses a goal: {said or 'it does not say why'}")

    def cancel(self) -> None:
        """End all goals that have been sent so far, those on their way too."""
        self._cancels.publish(ros().actionlib_msgs.GoalID(stamp=self._stamps.next(), id=""))

    def close(self) -> None:
        """Release the topics."""
        for each in (self._goals, self._cancels, self._status):
            each.unregister()

    def _heard(self, status: Any) -> None:
        with self._changed:
            self._states = {each.goal_id.id: (each.status, each.text) for each in status.status_list}
            self._changed.notify_all()
