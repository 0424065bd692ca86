"""A robot behind a ROS 1 master: `caretree run TASK --world ros1`."""

from __future__ import annotations

import contextlib
import time as wall
from dataclasses import replace

import numpy as np

from ..mechanics.kinematics import kinematics_of
from ..robot.baxter import BAXTER
from ..world import (
    BaseVelocity,
    Command,
    EmergencyStop,
    Frame,
    GripperOpening,
    HandTwist,
    JointTrajectory,
    Observation,
    RoomMap,
    SensorLost,
    Side,
    World,
    WorldError,
)
from .cameras import Cameras, Posture
from .clock import CAMERA_PERIOD, PACE, SIMULATED, Ros1Clock, RosTime, SteppedRos1Clock, parameter
from .master_watch import TIMES, UNHURRIED, MasterWatch
from .motions import Motions
from .rehearsal import BEGINS_WITH, Rehearsal
from .room import read_room
from .ros import ask_master, node, others_have, publisher, ros
from .senses import Senses
from .site import DEFAULT, read_site

WITHIN = 0.02  # [s] that a simulated robot's image may be late by its own clock
ALIVE = 0.05  # [s] of wall time between two signs of life


class Ros1World(World):
    """The contract, spoken over the topics and actions of a site.

    Args:
        site: name of one that comes with the package, or its .yaml file.
        master: address of the ROS master; what ROS_MASTER_URI says where it is empty.
        patience: how long the robot's topics may take to come [s].

    Attributes:
        site: as it was read.
        robot: Baxter.
        kinematics: of that model.
        initial_states: the one in which a simulated robot begins, by its name; empty where any will do.

    Raises:
        WorldError: ROS, the master, or something of the robot is missing; says what.
    """

    def __init__(self, site: str = DEFAULT, *, master: str = "", patience: float = 5.0) -> None:
        self.site = read_site(site)
        self._rospy, self._patience = node("caretree", master), patience
        self._rehearsal = Rehearsal(self._rospy)
        self._closed = True
        self._connect()

    def _connect(self) -> None:
        rospy, patience = self._rospy, self._patience
        # a simulated robot shows its map once the master knows whose time counts: until then `/clock` is not asked for
        self.room: RoomMap = read_room(rospy, self.site, patience)
        self._closed = False
        self._time = RosTime(rospy, bool(parameter(SIMULATED, False)))
        stepped = parameter(PACE, "wall") == "tree"
        self._frames_apart = parameter(CAMERA_PERIOD, np.inf) if stepped else np.inf  # [s]
        self._master = MasterWatch(self.stop, UNHURRIED if stepped else TIMES)
        self._senses = Senses(rospy, self.site, self._time.changed)
        self._senses.now = self._time.now
        self._motions = Motions(rospy, self.site, self._senses, self._time.now, at_once=stepped)
        self.robot = BAXTER  # whose joints a site's file names
        self.kinematics = kinematics_of(self.robot)
        self._cameras = Cameras(rospy, self.site, self._posture, self.kinematics)
        self._alive = publisher(rospy, self.site.alive, ros().std_msgs.Time, at_once=stepped)
        self._told = -np.inf
        try:
            self._wait_for_robot(patience)
        except WorldError:
            self.close()
            raise
        self._origin = self._time.now()
        self.clock = (
            SteppedRos1Clock(self._time, self._origin, self._ask, lambda: self._senses.complete - self._origin)
            if stepped
            else Ros1Clock(self._time, self._origin, self._tell)
        )
        self._master.begin()

    def observe(self) -> Observation:
        """Latest proprioception; raises SensorLost."""
        self._check()
        self._tell(self.clock.now())
        seen = self._senses.observation(self.kinematics)
        # a stamp may come before the clock's message of that time
        return replace(seen, time=min(seen.time - self._origin, self.clock.now()))

    def look(self, camera: str) -> Frame:
        """Latest frame; raises SensorLost."""
        self._check()
        # where time waits for the tree it waits for images too: on a busy machine they came seconds later
        self._cameras.wait(camera, self._time.now() - self._frames_apart - WITHIN)
        frame = self._cameras.look(camera)
        return replace(frame, stamp=min(frame.stamp - self._origin, self.clock.now()))

    def send(self, command: Command) -> Command:
        """Start a command."""
        self._check()
        if silent := self._master.silent:
            raise SensorLost(silent)
        self._tell(self.clock.now())
        if stopped := self._senses.stopped():
            raise EmergencyStop(stopped)
        if isinstance(command, JointTrajectory):
            return self._motions.follow(command)
        if isinstance(command, HandTwist):
            return self._motions.twist(command)
        if isinstance(command, BaseVelocity):
            return self._motions.drive(command)
        if isinstance(command, GripperOpening):
            return self._motions.grip(command)
        raise WorldError(f"the robot has no command {type(command).__name__}")

    def stop(self) -> None:
        """End every motion now."""
        if not self._closed:
            self._motions.stop()

    def close(self) -> None:
        """Leave the robot alone; twice is once."""
        if self._closed:
            return
        self._disconnect(self._rehearsal)

    def restart(self) -> None:
        """Bring a simulated robot back to its beginning, before a run.

        Raises:
            WorldError: it is a real one, or does not come back.
        """
        self._rehearsal.begin_anew(self._patience)
        self._disconnect()
        self._connect()

    @property
    def initial_states(self) -> tuple[str, ...]:
        """Of a real robot none is known: its room is as people have left it."""
        begins = parameter(BEGINS_WITH, "")
        return (begins,) if begins else ()

    def set_initial_state(self, name: str) -> None:
        """See that a run can begin there.

        Raises:
            WorldError: the simulated robot begins elsewhere.
        """
        states = self.initial_states
        if states and name not in states:
            raise WorldError(
                f"the simulated robot begins with {states[0]!r}, not {name!r}: caretree serve-robot --stage"
            )

    @property
    def person_offset(self) -> np.ndarray:
        """How far (3,) a made-up person has moved [m]."""
        return self._rehearsal.person_offset

    def fault_grip_slip(self, side: Side) -> None:
        """What that hand of a simulated robot holds slides out of it."""
        self._rehearsal.grip_slip(side)

    def fault_move_person(self) -> None:
        """The person before a simulated robot stirs."""
        self._rehearsal.move_person()

    def _disconnect(self, *more: Rehearsal) -> None:
        self._closed = True
        self._master.end()
        self._senses.on_joints = lambda sample: None
        try:
            ask_master("getPid", patience=TIMES.gone)
        except WorldError:
            return  # each topic would wait for an answer that does not come
        for each in (self._motions, self._senses, self._cameras, self._time, *more):
            with contextlib.suppress(Exception):  # the master may have gone
                each.close()
        with contextlib.suppress(Exception):
            self._alive.unregister()

    def _wait_for_robot(self, patience: float) -> None:
        ends = wall.monotonic() + patience
        while True:
            clock = ["/clock"] if self._time.simulated and self._time.now() <= 0.0 else []
            alive = [] if self._alive.get_num_connections() or not self._time.simulated else [self.site.alive]
            missing = clock + alive + self._senses.missing() + self._motions.missing()
            missing += [self.site.cameras[name].colour for name in self._cameras.missing()]
            if not missing:
                return
            if wall.monotonic() > ends:
                # on a busy computer some of it may only be late; what nobody has is the cause
                absent = sorted(set(missing) - others_have(missing), key=missing.index) or missing
                raise WorldError(f"the robot is not whole: nothing on {', '.join(absent)}; `caretree robot doctor`")
            self._alive.publish(ros().genpy.Time(0, int(self._time.now() * 1e9)))
            wall.sleep(0.02)

    def _check(self) -> None:
        if self._closed:
            raise WorldError("this world has been closed")
        if self._master.lost:
            raise SensorLost(self._master.lost)

    def _posture(self) -> Posture:
        joints = self._senses.joints
        if joints is None:
            raise SensorLost("no joint states have come")
        return self._senses.base()[0], joints.value[0], joints.value[3]

    def _tell(self, until: float) -> None:
        """A sign of life: the tree waits until then."""
        if (now := wall.monotonic()) - self._told >= ALIVE:
            self._told = now
            self._alive.publish(ros().genpy.Time(0, int((until + self._origin) * 1e9)))

    def _ask(self, until: float) -> float:
        """Let a simulated robot's time pass: in steps, while the servo steers it; how far [s]."""
        step = until
        if self._motions.servoing:
            step = min(until, max(self._motions.last_step() - self._origin, 0.0))
        self._alive.publish(ros().genpy.Time(0, int((step + self._origin) * 1e9)))
        return step
