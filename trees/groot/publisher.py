"""What Groot2 talks to: `caretree run TASK --groot`.

A thread answers.  The run only writes one byte when a node's status changes, which the trace tells, so that ticks cost
the same watched or not; a breakpoint alone holds it (`breakpoints.py`).
"""

from __future__ import annotations

import json
import secrets
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any

from py_trees.behaviour import Behaviour

from ...sim.errors import CaretreeError
from ..run.runner import Run
from .breakpoints import Breakpoints
from .plain import plain
from .protocol import (
    IDENTITY,
    IDLE_AFTER,
    STATE,
    Header,
    Hook,
    NodeStatus,
    ProtocolError,
    Request,
    Unlock,
    error_reply,
    place,
    read_json,
    states_of,
    transition,
)
from .shown_tree import ShownTree

HOST = "127.0.0.1"  # whoever can reach it can hold the run
PORT = 1667  # Groot2's own; what happens is published on the next one
INSTALL = "pip install 'caretree[groot]'"
LOOK = 100  # [ms] between two looks at whether the server is to end
KEPT = 1000  # changes of status that a recording keeps, as in BehaviorTree.CPP


class Publisher:
    """The server of one run.

    Args:
        port: that requests come to; breakpoints that are reached are published on the next one.

    Attributes:
        address: as Groot2 asks for it.

    Raises:
        CaretreeError: pyzmq is not installed, or a port is taken.
    """

    def __init__(self, port: int = PORT) -> None:
        try:
            import msgpack
            import zmq
        except ImportError as error:
            raise CaretreeError(f"--groot needs pyzmq and msgpack, which are not installed: {INSTALL}") from error
        self._pack: Any = msgpack.packb
        self._again = zmq.POLLIN
        self._zmq = zmq.Context()
        self._server, self._events = self._zmq.socket(zmq.REP), self._zmq.socket(zmq.PUB)
        self.address = f"{HOST}:{port}"
        try:
            for socket, number in ((self._server, port), (self._events, port + 1)):
                socket.setsockopt(zmq.LINGER, 0)
                socket.bind(f"tcp://{HOST}:{number}")
        except zmq.ZMQError as error:
            self._zmq.destroy(linger=0)
            raise CaretreeError(
                f"ports {port} and {port + 1} cannot be listened on: {error.strerror or error}"
            ) from error
        self._identity = secrets.token_bytes(IDENTITY)
        self._shown: _Shown | None = None
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._serve, name="groot", daemon=True)
        self._thread.start()

    def follow(self, run: Run) -> None:
        """Show `run` from now on.

        Args:
            run: before its first tick.

        Raises:
            CaretreeError: its tree is too large.
        """
        self._shown = _Shown(run, self._tell_reached)

    def event(self, event: Mapping[str, Any]) -> None:
        """Take over one event of the run's trace."""
        if self._shown is not None and event.get("kind") == "node":
            self._shown.change(str(event.get("node")), str(event.get("status")), float(event.get("t", 0.0)))

    def close(self) -> None:
        """End the server; a run that a breakpoint holds goes on."""
        self._closing.set()
        self._thread.join()
        if self._shown is not None:
            self._shown.breakpoints.remove_all()
        self._zmq.destroy(linger=0)

    def _serve(self) -> None:
        while not self._closing.is_set():
            if self._server.poll(LOOK, self._again):
                parts = self._server.recv_multipart()
                try:
                    reply = self._answer(parts)
                except CaretreeError as error:
                    reply = error_reply(str(error))
                except Exception as error:  # a value on the board that cannot be shown, or changes meanwhile
                    reply = error_reply(f"{type(error).__name__}: {error}")
                self._server.send_multipart(reply)

    def _answer(self, parts: list[bytes]) -> list[bytes]:
        header = Header.read(parts[0])
        if self._shown is None:
            raise ProtocolError("the run has not begun yet")
        content = self._shown.answer(header.request, parts[1:], self._pack)
        return [header.written(self._identity), *content]

    def _tell_reached(self, uid: int) -> None:
        """Called in the run's thread, which alone publishes."""
        self._events.send_multipart([Header(Request.REACHED, secrets.randbits(32)).written(), str(uid).encode()])


class _Shown:
    """A run as it is shown: its tree, the statuses, its breakpoints."""

    def __init__(self, run: Run, reached: Callable[[int], None]) -> None:
        self._tree = ShownTree(run.root)
        self._board = run.context.board
        self._tell = reached
        nodes = self._tree.nodes()
        self._states = states_of((uid, NodeStatus.IDLE) for uid in sorted(nodes))
        self._uids = {path: self._tree.uids[node] for node, path in run.trace.paths.items()}
        self.breakpoints = Breakpoints(run, nodes, self._reached)
        self._since: float | None = None
        self._now = run.context.now
        self._changes: deque[bytes] = deque(maxlen=KEPT)

    def change(self, path: str, status: str, t: float) -> None:
        """A node has come to `status` at `t` [s] of the world's clock."""
        for uid in self._uids.get(path, ()):
            before = self._states[_byte(uid)]
            if status == "INVALID":
                self._states[_byte(uid)] = before if before >= IDLE_AFTER or not before else before + IDLE_AFTER
            else:
                self._states[_byte(uid)] = NodeStatus[status]
            if self._since is not None:
                self._changes.append(transition(t - self._since, uid, self._states[_byte(uid)] % IDLE_AFTER))

    def answer(self, request: Request, rest: list[bytes], pack: Callable[[Any], bytes]) -> list[bytes]:
        """What stands behind the header of the reply."""
        self.breakpoints.hear()
        if request is Request.FULL_TREE:
            return [self._tree.xml.encode()]
        if request is Request.STATUS:
            return [bytes(self._states)]
        if request is Request.DUMP:
            return [json.dumps([hook.content() for hook in self.breakpoints.hooks()]).encode()]
        if request is Request.REMOVE_ALL:
            self.breakpoints.remove_all()
            return []
        if request is Request.DISABLE_ALL:
            self.breakpoints.disable_all()
            return []
        if request is Request.TRANSITIONS:
            changes = [self._changes.popleft() for _ in range(len(self._changes))]
            return [b"".join(changes)]
        if len(rest) != 1:
            raise ProtocolError("must be 2 parts message")
        return self._answer_to(request, rest[0], pack)

    def _answer_to(self, request: Request, content: bytes, pack: Callable[[Any], bytes]) -> list[bytes]:
        """The same for requests that have a content."""
        if request is Request.BLACKBOARD:
            asked = [name for name in content.decode(errors="replace").split(";") if name] or self._tree.boards[:1]
            values = {name: plain(self._board.get(name)) for name in sorted(self._board.keys())}
            return [pack({name: values for name in asked if name in self._tree.boards})]
        if request is Request.INSERT:
            for hook in Hook.read(content):
                self.breakpoints.insert(hook)
        elif request is Request.REMOVE:
            self.breakpoints.remove(*place(read_json(content)))
        elif request is Request.UNLOCK:
            self.breakpoints.unlock(Unlock.read(content))
        elif request is Request.RECORD:
            return self._record(content)
        else:
            raise ProtocolError(f"{request.name} is told, not asked for")
        return []

    def _record(self, word: bytes) -> list[bytes]:
        """Begin or end to keep changes; what they are counted from is told [us of the wall clock]."""
        if word == b"start":
            self._changes.clear()
            self._since = self._now()
            return [str(round(time.time() * 1e6)).encode()]
        self._since = None
        return []

    def _reached(self, uid: int, node: Behaviour) -> None:
        """Tell it, and show the way to the node as running, which the trace knows only when the tick has ended."""
        above = node.parent
        while above is not None:
            for each in self._tree.uids[above]:
                self._states[_byte(each)] = NodeStatus.RUNNING
            above = above.parent
        self._tell(uid)


def _byte(uid: int) -> int:
    """Where the status of a node stands: numbers begin with 1."""
    return STATE.size * uid - 1
