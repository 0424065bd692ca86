"""The time of a robot behind a master: the wall's, or what `/clock` says."""

from __future__ import annotations

import threading
import time as wall
from typing import Any

from ..scripted.clock import SteppedClock
from ..world import WorldError
from .ros import ask_master, ros

LONGEST = 0.1  # [s] of wall time that a wait may take
LOOK = 0.01  # [s] between two looks where nobody wakes who waits
SLOW = 60.0  # [s] of wall time that a simulation may compute
PACE = "/caretree/pace"  # parameter: `tree` where a simulated robot's time passes only as far as the tree waits
SIMULATED = "/use_sim_time"
CAMERA_PERIOD = "/caretree/camera_period"  # parameter: [s] of a simulated robot's time between two images


def parameter(name: str, default: Any = None) -> Any:
    """A parameter of the master.

    Raises:
        WorldError: the master does not answer.
    """
    there = ask_master("hasParam", name)
    return ask_master("getParam", name) if there else default


class RosTime:
    """Tells the time in seconds as stamps have it.

    Args:
        rospy: the node.
        simulated: `/clock` tells it.

    Attributes:
        step: between the last two times that `/clock` told [s]: what happened meanwhile is stamped ahead of it.
    """

    def __init__(self, rospy: Any, simulated: bool) -> None:
        self.changed = threading.Condition()
        self.simulated = simulated
        self._time, self.step = 0.0, 0.0
        self._clock = (
            rospy.Subscriber("/clock", ros().rosgraph_msgs.Clock, self._tick, tcp_nodelay=True) if simulated else None
        )

    def now(self) -> float:
        """Seconds; 0 where `/clock` has said nothing yet."""
        return self._time if self.simulated else wall.time()

    def _tick(self, message: Any) -> None:
        with self.changed:
            told = message.clock.to_sec()
            if told > self._time:
                self.step = told - self._time if self._time else 0.0
                self._time = told
            self.changed.notify_all()

    def close(self) -> None:
        """Listen no more."""
        if self._clock is not None:
            self._clock.unregister()


class Ros1Clock:
    """Time passes there by itself.

    Args:
        time: as stamps have it.
        origin: that is 0 on this clock [s].
        before_waiting: told until when somebody waits [s]: a sign of life.
    """

    def __init__(self, time: RosTime, origin: float, before_waiting: Any) -> None:
        self._ros, self._origin, self._tell = time, origin, before_waiting
        self._last = 0.0

    def now(self) -> float:
        """Seconds since this world was made; never less than before."""
        self._last = max(self._last, self._ros.now() - self._origin)
        return self._last

    def wait_until(self, time: float) -> None:
        """Return when it is `time` [s], or 0.1 s of wall time later."""
        self._tell(time)
        ends = wall.monotonic() + LONGEST
        with self._ros.changed:
            while self.now() < time and (left := ends - wall.monotonic()) > 0.0:
                self._ros.changed.wait(min(left, LOOK) if self._ros.simulated else min(left, time - self.now()))


class SteppedRos1Clock(SteppedClock):
    """Time passes there as far as somebody waits here: for counting outcomes, whatever the machine has to do."""

    def __init__(self, time: RosTime, origin: float, ask: Any, measured: Any) -> None:
        super().__init__(self._wait)
        self._ros, self._origin, self._ask, self._measured = time, origin, ask, measured
        self.now = lambda: max(time.now() - origin, 0.0)  # type: ignore[method-assign] the time is the robot's

    def _wait(self, until: float) -> None:
        """Ask again and again: the robot takes `ask` for a sign of life as well."""
        began, ends = wall.monotonic(), wall.monotonic() + SLOW
        while True:
            step = self._ask(until)
            with self._ros.changed:
                again = wall.monotonic() + LONGEST
                while not (done := min(self.now(), self._measured()) >= step - 1e-6) and wall.monotonic() < again:
                    self._ros.changed.wait(LOOK)
            if done and step >= until - 1e-6:
                return
            if done:
                ends = wall.monotonic() + SLOW
            elif wall.monotonic() > ends:
                raise WorldError(f"the robot's time has stood still for {wall.monotonic() - began:.0f} s")
