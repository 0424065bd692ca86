"""A world that is served by another process: `caretree serve-world` there, `--world remote` here."""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections.abc import Callable
from typing import Any

from ..abilities import HandKinematics
from ..errors import CaretreeError
from ..known_robots import robot_named
from ..scripted.clock import SteppedClock
from ..scripted.linear_arm import LinearArms
from ..world import Command, Frame, Observation, SensorLost, World, WorldError
from .messages import VERSION, Connection
from .values import ERRORS, packed, unpacked

PORT = 7272
RECENT = 0.005  # [s] of wall time for which an answer tells the time
SLOW = 120.0  # [s] that a simulation may compute


class RemoteWorld(World):
    """The contract, spoken over a socket.

    Args:
        address: `host:port`, or the host alone.
        patience: how long a robot may take to answer [s]; a simulation may take `SLOW`.
        robot: name of its model, as `--robot` has it; the one that the other side names by default.
        kinematics: what the guard shall know of where the hands are; by default its robot's model, or the scripted
            world's made up arms where these are behind the socket.
        now: the wall clock [s].

    Raises:
        WorldError: nobody is there, or it speaks another version.
        RobotError: its robot is not known here.
    """

    def __init__(
        self,
        address: str = f"127.0.0.1:{PORT}",
        *,
        patience: float = 1.0,
        robot: str | None = None,
        kinematics: HandKinematics | None = None,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        host, _, port = address.rpartition(":")
        if not host:
            host, port = port, str(PORT)
        if not port.isdigit():
            raise WorldError(f"address is {address!r}, but host:port is asked for")
        self._address, self._patience, self._wall = address, 5.0, now
        self._asking, self._sending = threading.Lock(), threading.Lock()
        self._lost = ""
        self._time, self._told = 0.0, -float("inf")
        try:
            self._connection = Connection(socket.create_connection((host, int(port)), 5.0))
        except OSError as error:
            raise WorldError(f"no world is served at {address}: {error.strerror or error}") from error
        try:
            told = self._request("hello", VERSION)
            self.robot = robot_named(robot or told["robot"])
        except CaretreeError:
            self.close()
            raise
        self._patience = SLOW if told["stepped"] else patience
        self.served: str = told["name"]
        self.room = unpacked(told["room"])
        self.kinematics = kinematics or (LinearArms() if told.get("made_up_arms") else None)
        self.clock = _SteppedRemoteClock(self) if told["stepped"] else _RemoteClock(self)

    def observe(self) -> Observation:
        """Latest proprioception; raises SensorLost, also where the world is lost."""
        return self._sense("observe")

    def look(self, camera: str) -> Frame:
        """Latest frame; raises SensorLost, also where the world is lost."""
        return self._sense("look", camera)

    def send(self, command: Command) -> Command:
        """Start a command."""
        return unpacked(self._request("send", (packed(command),)))

    def stop(self) -> None:
        """End every motion now; it waits for no answer, and for nobody who does.

        Raises:
            WorldError: the world is lost; it then stops its robot itself.
        """
        self._tell(("stop", ()))

    def close(self) -> None:
        """Hang up; the world stops its robot."""
        self._lost = self._lost or "it has been closed"
        with contextlib.suppress(OSError):
            self._connection.close()

    def now(self) -> float:
        """The world's clock as it was last told, asked for anew where that is not recent [s].

        It stands still where the world is lost.
        """
        stepped = isinstance(self.clock, SteppedClock)  # then time passes only where it is asked to
        if not (stepped or self._lost) and self._wall() - self._told > RECENT:
            with contextlib.suppress(WorldError):
                self._request("now", ())
        return self._time

    def wait_until(self, time: float) -> None:
        """Have the world wait until `time` [s]."""
        self._request("wait_until", (float(time),))

    def _sense(self, what: str, *values: Any) -> Any:
        try:
            return unpacked(self._request(what, values))
        except SensorLost:
            raise
        except WorldError as error:
            if self._lost:
                raise SensorLost(str(error)) from error
            raise

    def _request(self, what: str, values: Any) -> Any:
        with self._asking:
            self._tell((what, values))
            try:
                error, answer, now = self._connection.receive(self._patience)
            except (EOFError, OSError, WorldError, TypeError, ValueError) as lost:
                raise self._failed(lost) from lost
            self._time, self._told = max(self._time, now), self._wall()
        if error:
            raise ERRORS.get(error, WorldError)(answer if error in ERRORS else f"{error}: {answer}")
        return answer

    def _tell(self, message: Any) -> None:
        if self._lost:
            raise WorldError(f"the world at {self._address} is lost: {self._lost}")
        with self._sending:
            try:
                self._connection.send(message)
            except OSError as lost:
                raise self._failed(lost) from lost

    def _failed(self, why: Exception) -> WorldError:
        """A late answer would be taken for that to the next question: the line is given up."""
        waited = isinstance(why, TimeoutError)
        self._lost = self._lost or (f"it did not answer within {self._patience:g} s" if waited else str(why))
        with contextlib.suppress(OSError):
            self._connection.close()
        return WorldError(f"the world at {self._address} is lost: {self._lost}")


class _RemoteClock:
    """Time passes there by itself."""

    def __init__(self, world: RemoteWorld) -> None:
        self.now, self.wait_until = world.now, world.wait_until


class _SteppedRemoteClock(SteppedClock):
    """Time passes there when somebody waits here."""

    def __init__(self, world: RemoteWorld) -> None:
        super().__init__(world.wait_until)
        self.now = world.now  # type: ignore[method-assign] the time is the other world's
