"""The robot's side: serves a simulated world on the topics and actions of a site, with `/clock`, as a robot does.

For tests, and for whoever wants to rehearse before the robot is there.  Its time passes in one of two paces:

| pace | time passes | for |
|---|---|---|
| `wall` | by itself, `speed` times as fast as the wall's, if the simulation can | faults, latencies, rehearsals |
| `tree` | only as far as the tree waits | outcomes, whatever else the machine has to do |

The red button is a message on `/robot/set_super_stop`; `/robot/set_super_reset` releases it and
`/robot/set_super_enable` enables the robot again, as Baxter has it.  Where no sign of life comes from a tree that has
been heard, the robot is stopped.  What a fault campaign asks beyond that is in `rehearsal.py`.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any, Literal

import numpy as np

from ..abilities import SupportsFaults, SupportsInitialStates, TakesJointVelocities
from ..compiled import load
from ..mechanics.kinematics import kinematics_of
from ..world import SIDES, BaseVelocity, World, WorldError
from .clock import CAMERA_PERIOD, PACE, SIMULATED
from .messages import message
from .rehearsal import BEGIN_ANEW, BEGINS_WITH, BEGUN, GRIP_SLIP, PERSON_MOVES, PERSON_OFFSET
from .robot_actions import RobotActions
from .robot_topics import RobotTopics
from .room import room_messages
from .ros import node, ros
from .site import DEFAULT, read_site

Pace = Literal["wall", "tree"]
START = 1000.0  # [s] that `/clock` says at first: ROS takes 0 for no time at all
APART = 1.0  # [s] between the last time of one world and the first of the next
HOLD_VELOCITY = 0.2  # [s] for which a joint velocity counts, as Baxter has it
HOLD_BASE = 0.25  # [s] for which a velocity of the base counts
SILENCE = 0.3  # [s] of wall time without a sign of life after which the robot is stopped
AGAIN = 0.1  # [s] between two stops
LATE = 0.1  # [s] behind which a simulation no longer catches up with the wall clock
OTHERS = 0.001  # [s] of wall time in which commands that came before the tree's leave to go on are taken
WAIT = 0.05  # [s] between two looks whether to end


class RobotSide:
    """A node that is a robot.

    Args:
        make: makes its world, simulated and at its beginning; once more whenever a tree asks to begin anew.
        site: names the topics.
        master: address; what ROS_MASTER_URI says where it is empty.
        pace: who lets time pass.
        speed: of time, at most, where the pace is the wall's.
        rate: of joint states and `/clock` [Hz]; the other senses come half as often.
        camera_rate: of images [Hz].
        begins_with: name of the state in which the worlds begin; empty for the usual one.

    Attributes:
        world: the present one.
        stops: how often the robot was stopped because its tree was silent.

    Raises:
        WorldError: no master answers, or this world's arms cannot be driven joint by joint.
    """

    def __init__(
        self,
        make: Callable[[], World],
        site: str = DEFAULT,
        *,
        master: str = "",
        pace: Pace = "wall",
        speed: float = 1.0,
        rate: float = 100.0,
        camera_rate: float = 5.0,
        begins_with: str = "",
    ) -> None:
        rospy = node("robot", master)
        load()  # else within the first motion, which would leave the tree without joint states
        world = make()
        if not isinstance(world, TakesJointVelocities):
            world.close()
            raise WorldError(f"the arms of {type(world).__name__} cannot be driven joint by joint, as a robot's are")
        self.stops = 0
        self.world, self._make, self._pace, self._speed, self._period = world, make, pace, speed, 1.0 / rate
        self._lock = threading.RLock()
        self._ended = threading.Event()
        self._may_go = threading.Condition()
        self._allowed, self._heard, self._stopped = 0.0, 0.0, 0.0  # the tree's [s], wall clock [s]
        self._pressed, self._enabled = False, True
        self._start, self._anew = START, 0
        self._site = read_site(site)
        rospy.set_param(SIMULATED, True)
        rospy.set_param(PACE, pace)
        rospy.set_param(CAMERA_PERIOD, 1.0 / camera_rate)
        rospy.set_param(BEGINS_WITH, begins_with or _first_state(world))
        grid, notes = room_messages(world.room)
        rospy.set_param(self._site.room.annotations, notes)
        there = ros()
        self._grid = rospy.Publisher(self._site.room.grid, there.nav_msgs.OccupancyGrid, latch=True, queue_size=1)
        self._grid.publish(grid)
        self._rospy, self._topics = rospy, RobotTopics(rospy, self._site, kinematics_of(world.robot), camera_rate)
        self._topics.begin(self._start)
        self._actions = RobotActions(self._site, world, self._lock, self.allowed)
        self._offset = rospy.Publisher(PERSON_OFFSET, there.geometry_msgs.Vector3, latch=True, queue_size=1)
        self._listen(rospy, there)

    def _listen(self, rospy: Any, there: Any) -> None:
        def listen(topic: str, kind: Any, heard: Callable[[Any], None]) -> None:
            rospy.Subscriber(topic, kind, heard, queue_size=10, tcp_nodelay=True)

        for side in SIDES:
            command = message("baxter_core_msgs/JointCommand")
            listen(self._site.arms[side].velocity, command, lambda m, side=side: self._velocities(side, m))
        listen(self._site.base.command, there.geometry_msgs.Twist, self._drive)
        listen(self._site.alive, there.std_msgs.Time, self._hear)
        listen(BEGIN_ANEW, there.std_msgs.UInt32, self._hear_begin)
        listen(GRIP_SLIP, there.std_msgs.String, self._slip)
        listen(PERSON_MOVES, there.std_msgs.Empty, lambda _: self._move_person())
        listen("/robot/set_super_stop", there.std_msgs.Empty, lambda _: self.press())
        listen("/robot/set_super_reset", there.std_msgs.Empty, lambda _: self.release())
        listen("/robot/set_super_enable", there.std_msgs.Bool, lambda m: self.enable(m.data))

    # -- the red button ----------------------------------------------------------------------------------

    def press(self) -> None:
        """Somebody presses it."""
        self._pressed, self._enabled = True, False
        self._stop()

    def release(self) -> None:
        """Somebody turns it until it springs out; the robot is not yet enabled."""
        self._pressed = False

    def enable(self, enabled: bool) -> None:
        """Enable the robot, or disable it; it is stopped then."""
        self._enabled = enabled and not self._pressed
        if not self._enabled:
            self._stop()

    def allowed(self) -> str:
        """Why nothing may move; empty where it may."""
        return "" if self._enabled else "the robot is not enabled"

    # -- time --------------------------------------------------------------------------------------------

    def serve(self) -> None:
        """Be a robot until `end` is called."""
        began, first = time.monotonic(), self.world.clock.now()
        self._publish(everything=True)
        while not self._ended.is_set():
            if self._anew:
                self._begin_anew()
                began, first = time.monotonic(), self.world.clock.now()
            now = self.world.clock.now()
            if self._pace == "tree":
                self._advance_with_tree(now)
                continue
            behind = (time.monotonic() - began) * self._speed - (now - first)
            if behind < self._period:
                self._ended.wait(min((self._period - behind) / self._speed, WAIT))
                continue
            if behind > LATE * self._speed:
                began, first = time.monotonic(), now
            self._advance(now + self._period)
            self._publish()
            self._watch_tree()

    def end(self) -> None:
        """Make `serve` return."""
        self._ended.set()

    def _advance_with_tree(self, now: float) -> None:
        with self._may_go:
            if self._allowed <= now + 1e-6:
                self._may_go.wait(WAIT)
        until = self._allowed
        if until <= now + 1e-6:
            self._publish(everything=True, again=True)  # who comes later wants to see something too
            return
        time.sleep(OTHERS)
        while now < until - 1e-6 and not self._ended.is_set() and not self._anew:
            now = min(now + self._period, until)
            self._advance(now)
            self._publish(everything=now >= until - 1e-6)

    def _advance(self, until: float) -> None:
        with self._lock:
            self.world.clock.wait_until(until)
            self._actions.finish(self.world.clock.now())

    def _publish(self, *, everything: bool = False, again: bool = False) -> None:
        with self._lock:
            self._topics.publish(self.world, self._pressed, self._enabled, everything=everything, again=again)

    # -- rehearsals --------------------------------------------------------------------------------------

    def _hear_begin(self, number: Any) -> None:
        with self._may_go:
            self._anew = number.data
            self._may_go.notify_all()

    def _begin_anew(self) -> None:
        """Go on with a fresh world; `/clock` does not go back."""
        number, self._anew = self._anew, 0
        with self._lock:
            self._actions.abort(fingers=True)
            self._start += self.world.clock.now() + APART
            self.world.close()
            self.world = self._actions.world = self._make()
            self._topics.begin(self._start)
            self._pressed, self._enabled = False, True
            self._allowed = self._heard = 0.0
            self._tell_of_person()
            self._publish(everything=True, again=True)
        self._rospy.set_param(BEGUN, number)

    def _slip(self, side: Any) -> None:
        with self._lock:
            if isinstance(self.world, SupportsFaults) and side.data in SIDES:
                self.world.fault_grip_slip(side.data)

    def _move_person(self) -> None:
        with self._lock:
            if isinstance(self.world, SupportsFaults):
                self.world.fault_move_person()
                self._tell_of_person()

    def _tell_of_person(self) -> None:
        """Made up senses have no images to see the person in."""
        offset = getattr(self.world, "person_offset", None)
        if offset is not None:
            self._offset.publish(*map(float, offset))

    # -- commands ----------------------------------------------------------------------------------------

    def _velocities(self, side: Any, command: Any) -> None:
        arm = self._site.arms[side]
        if self.allowed() or command.mode != command.VELOCITY_MODE or set(command.names) != set(arm.joints):
            return
        rates = dict(zip(command.names, command.command, strict=True))
        with self._lock:
            self._actions.forget(side)
            moved: Any = self.world
            moved.send_joint_velocities(side, [rates[name] for name in arm.joints], HOLD_VELOCITY)

    def _drive(self, twist: Any) -> None:
        if not self.allowed():
            velocity = (twist.linear.x, twist.linear.y, twist.angular.z)
            with self._lock:
                lasts = HOLD_BASE if any(velocity) else 0.0
                self.world.send(BaseVelocity(velocity=np.array(velocity), duration=lasts))

    def _hear(self, until: Any) -> None:
        with self._may_go:
            self._heard = time.monotonic()
            self._allowed = until.data.to_sec() - self._start
            self._may_go.notify_all()

    def _watch_tree(self) -> None:
        now = time.monotonic()
        if self._heard and now - self._heard > SILENCE and now - self._stopped > AGAIN:
            self.stops += 1
            self._stop()

    def _stop(self) -> None:
        self._stopped = time.monotonic()
        with self._lock:
            self._actions.abort()
            self.world.stop()


def _first_state(world: World) -> str:
    """The state in which a world begins if nobody says otherwise; empty where it has but one."""
    first = next(iter(world.initial_states), "") if isinstance(world, SupportsInitialStates) else ""
    return str.__str__(first)  # a member of an enumeration is no parameter
