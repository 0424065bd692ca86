"""A run of a small task that is served, and somebody who asks as Groot2 does."""

import json
import socket
import threading
import time
from pathlib import Path

import pytest
import zmq
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills import HoldStill, MoveJoint, Retreat
from caretree.skills.core.ports import Key
from caretree.trees import FailSafe, Stage, sequence
from caretree.trees.groot import breakpoints
from caretree.trees.groot.protocol import HEADER, Header, Request
from caretree.trees.groot.publisher import Publisher
from caretree.trees.run.runner import Run
from caretree.trees.run.task import Task


def free_port():
    """A port that is free together with the next one."""
    while True:
        with socket.socket() as first, socket.socket() as second:
            first.bind(("127.0.0.1", 0))
            port = first.getsockname()[1]
            try:
                second.bind(("127.0.0.1", port + 1))
            except (OSError, OverflowError):
                continue
            return port


def until(holds):
    """Wait until something holds that another thread brings about."""
    ends = time.monotonic() + 60.0
    while not (held := holds()):
        assert time.monotonic() < ends
        time.sleep(0.005)
    return held


class Groot:
    """Asks one request after the other, and hears of breakpoints that are reached."""

    def __init__(self, port):
        self._zmq = zmq.Context()
        self._asks, self._hears = self._zmq.socket(zmq.REQ), self._zmq.socket(zmq.SUB)
        self._hears.setsockopt(zmq.SUBSCRIBE, b"")
        for each, number in ((self._asks, port), (self._hears, port + 1)):
            each.setsockopt(zmq.RCVTIMEO, 30_000)
            each.connect(f"tcp://127.0.0.1:{number}")
        self._number = 0

    def ask(self, request, content=None):
        """The parts of the reply behind its header."""
        self._number += 1
        header = Header(request, self._number).written()
        parts = [header] if content is None else [header, content]
        self._asks.send_multipart(parts)
        first, *rest = self._asks.recv_multipart()
        if first == b"error":
            return rest[0].decode()
        assert first[: HEADER.size] == header
        assert len(first) == HEADER.size + 16
        return rest

    def hook(self, uid, position=0, once=False, **changes):
        """Set a breakpoint; the error if it is refused."""
        content = {"enabled": True, "uid": uid, "mode": 0, "once": once, "desired_status": "SKIPPED"}
        return self.ask(Request.INSERT, json.dumps(content | {"position": position} | changes).encode())

    def unlock(self, uid, position=0, remove=False, status="SKIPPED"):
        """Let go on; the error if it is refused."""
        content = {"uid": uid, "position": position, "desired_status": status, "remove_when_done": remove}
        return self.ask(Request.UNLOCK, json.dumps(content).encode())

    def reached(self):
        """Number of the node whose breakpoint was reached next."""
        header, uid = self._hears.recv_multipart()
        assert Header.read(header).request is Request.REACHED
        return int(uid)

    def close(self):
        self._zmq.destroy(linger=0)


def build(context):
    """Turn a wrist, hold still, turn it back."""
    before = Key("before")
    body = sequence(
        "all",
        MoveJoint("up", context, side="left", joint="w1", angle=0.4, before=before),
        Stage("rest", None, HoldStill("still", context, seconds=1.0)),
        MoveJoint("down", context, side="left", joint="w1", angle=before, relative=False),
    )
    return FailSafe("safely", body, Retreat("let go", context, hand_distance=0.0, ready="never"))


class Served:
    """A run that is served and has not begun; `begin` lets it go on in a thread."""

    def __init__(self, watched=True):
        self.world = ScriptedWorld(seed=100)
        self.port = free_port()
        self.publisher = Publisher(self.port) if watched else None
        self.events = []
        self.run = Run(Task("small", build, Path(__file__)), self.world, recorder=self)
        if self.publisher:
            self.publisher.follow(self.run)
        self.results = []
        self.thread = threading.Thread(target=lambda: self.results.append(self.run.run()))

    def event(self, event):
        self.events.append(event)
        if self.publisher:
            self.publisher.event(event)

    def begin(self):
        self.thread.start()

    def result(self):
        self.thread.join()
        return self.results[0]

    def close(self):
        self.run.request_stop()
        if self.thread.ident:
            self.thread.join()
        if self.publisher:
            self.publisher.close()


@pytest.fixture(autouse=True)
def patience(monkeypatch):
    """A machine that is busy is not taken for a viewer that has gone."""
    monkeypatch.setattr(breakpoints, "PATIENCE", 600.0)


@pytest.fixture
def served():
    each = Served()
    yield each
    each.close()


@pytest.fixture
def groot(served):
    each = Groot(served.port)
    yield each
    each.close()


@pytest.fixture
def uid(served):
    """The number of a node by its name."""
    shown = served.publisher._shown._tree
    return lambda name: next(uids[-1] for node, uids in shown.uids.items() if node.name == name)


@pytest.fixture
def unwatched():
    """The result of the same run that nobody watches."""
    return Served(watched=False).run.run()
