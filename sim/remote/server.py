"""Serves a world to a tree in another process, and stops its robot when that tree falls silent or is gone."""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections.abc import Callable
from typing import Any

from ..blame import OF_FOREIGN_CODE
from ..compiled import load
from ..scripted.clock import SteppedClock
from ..scripted.linear_arm import LinearArms
from ..world import World, WorldError
from .messages import VERSION, Connection
from .values import packed, unpacked

SILENCE = 0.3  # [s] without a message after which a robot whose time passes by itself is stopped
LOOK = 0.05  # [s] between two looks whether a message has come
AGAIN = 0.1  # [s] between two stops: one may be lost
PATIENCE = 5.0  # [s] with a driver that raises when it is stopped
CALLS = ("observe", "look", "send")


class WorldServer:
    """Offers one world, to one tree at a time.  Whoever reaches the address may move the robot.

    Args:
        world: closed by whoever made it.
        host: of the network that may reach it.
        port: 0 for any that is free.
        now: the wall clock [s].

    Attributes:
        address: `host:port`.

    Raises:
        OSError: the port is taken.
    """

    def __init__(
        self, world: World, host: str = "127.0.0.1", port: int = 0, *, now: Callable[[], float] = time.monotonic
    ) -> None:
        self._world = world
        self._now = now
        self._asked: float | None = None  # when the call began that the world has not answered yet
        self._stepped = isinstance(world.clock, SteppedClock)
        load()  # else within the first motion, which would leave the tree without an answer
        self._listener = socket.create_server((host, port))
        self.address = "{}:{}".format(*self._listener.getsockname()[:2])
        self._answers: dict[str, Callable[..., Any]] = {name: getattr(world, name) for name in CALLS}
        self._answers |= {"now": world.clock.now, "wait_until": world.clock.wait_until}

    def serve_one(self) -> str:
        """Wait for a tree, answer it until it is gone, and stop the robot; why it ended, one clause.

        Raises:
            OSError: this server has been closed.
        """
        line, (host, *_) = self._listener.accept()
        connection = Connection(line)
        over = threading.Event()
        watch = threading.Thread(target=self._watch, args=(over,), name="watchdog", daemon=True)
        if not self._stepped:
            watch.start()
        try:
            self._greet(connection)
            while True:
                self._answer(connection, *self._next(connection))
        except (EOFError, OSError, WorldError, TypeError, ValueError) as error:
            return f"{host}: {error}"
        finally:
            self._stop_for_sure()
            over.set()
            connection.close()

    def close(self) -> None:
        """Serve nobody any more; twice is once."""
        with contextlib.suppress(OSError):  # it wakes who waits for a tree
            self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()

    def _greet(self, connection: Connection) -> None:
        what, version = connection.receive(5.0)
        if (what, version) != ("hello", VERSION):
            sentence = f"this world speaks version {VERSION} of the messages, the tree {version}"
            connection.send((WorldError.__name__, sentence, 0.0))
            raise WorldError(sentence)
        world = self._world
        told = {"name": type(world).__name__, "stepped": self._stepped, "robot": world.robot.name}
        told["room"] = packed(world.room)
        told["made_up_arms"] = isinstance(getattr(world, "kinematics", None), LinearArms)
        connection.send(("", told, float(self._world.clock.now())))

    def _next(self, connection: Connection) -> tuple[str, tuple[Any, ...]]:
        """The next message; while none comes the robot is stopped."""
        heard, stopped = self._now(), -float("inf")
        while True:
            try:
                what, values = connection.receive(LOOK)
                return what, values
            except TimeoutError:
                now = self._now()
                if not self._stepped and now - heard > SILENCE and now - stopped >= AGAIN:
                    stopped = now
                    self._stop()

    def _answer(self, connection: Connection, what: str, values: tuple[Any, ...]) -> None:
        if what == "stop":
            self._stop()
            return
        self._asked = self._now()
        try:
            answer = "", packed(self._answers[what](*map(unpacked, values)))
        except Exception as error:
            answer = type(error).__name__, str(error)
        finally:
            self._asked = None
        connection.send((*answer, float(self._world.clock.now())))

    def _watch(self, over: threading.Event) -> None:
        """Stop the robot while a call of the world hangs: nobody hears meanwhile what the tree says, or if it lives."""
        while not over.wait(AGAIN):
            asked = self._asked
            if asked is not None and self._now() - asked > SILENCE:
                with contextlib.suppress(BaseException):  # whatever it raises, the next look stops again
                    self._stop()

    def _stop_for_sure(self) -> None:
        """Stop until the world takes it, as long as a driver may be busy: nobody asks again once the tree has gone."""
        for _ in range(round(PATIENCE / AGAIN)):
            if self._stop():
                return
            time.sleep(AGAIN)

    def _stop(self) -> bool:
        """Stop once; whether the world took it."""
        try:
            self._world.stop()
        except OF_FOREIGN_CODE:
            return False
        return True
