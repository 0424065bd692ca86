"""The bytes that Groot2 and `Groot2Publisher` of BehaviorTree.CPP 4 exchange, protocol 2.

Every message has parts.  The first one of a request is its header; the reply begins with that header, followed by 16
bytes that tell one tree from another.  What goes wrong is answered by the two parts `error` and a sentence.

| bytes, little endian | what |
|---|---|
| 1 | number of the protocol |
| 1 | type of the request |
| 4 | chosen by who asks, returned as it is |
| 16, in replies only | identity of the tree |
"""

from __future__ import annotations

import json
import struct
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum, IntEnum
from typing import Any

from ...sim.errors import CaretreeError

PROTOCOL = 2
HEADER = struct.Struct("<BBI")
STATE = struct.Struct("<HB")  # uid and status of one node
IDENTITY = 16  # [bytes]
IDLE_AFTER = 10  # added to the status that a node had when it became idle
LARGEST_UID = 0xFFFF


class ProtocolError(CaretreeError):
    """A request that is not understood, or not granted; the sentence is the reply."""


class Request(Enum):
    """What is asked for, by the letter on the wire."""

    FULL_TREE = b"T"
    STATUS = b"S"
    BLACKBOARD = b"B"
    INSERT = b"I"
    REMOVE = b"R"
    REACHED = b"N"  # published, never asked
    UNLOCK = b"U"
    DUMP = b"D"
    REMOVE_ALL = b"A"
    DISABLE_ALL = b"X"
    RECORD = b"r"
    TRANSITIONS = b"t"


class NodeStatus(IntEnum):
    """What a node may be in."""

    IDLE = 0
    RUNNING = 1
    SUCCESS = 2
    FAILURE = 3


class Position(IntEnum):
    """On which side of a node a breakpoint is."""

    BEFORE = 0
    AFTER = 1


BREAKPOINT = 0  # the one kind of hook that is granted; the other one replaces what a node returns


@dataclass(frozen=True)
class Header:
    """The first part of a request.

    Attributes:
        request: what is asked for.
        number: chosen by who asks.
    """

    request: Request
    number: int = 0

    @classmethod
    def read(cls, part: bytes) -> Header:
        """The header in `part`.

        Raises:
            ProtocolError: it is none.
        """
        if len(part) != HEADER.size:
            raise ProtocolError(f"wrong request header: {len(part)} bytes, but there are {HEADER.size}")
        protocol, letter, number = HEADER.unpack(part)
        if protocol != PROTOCOL:
            raise ProtocolError(f"protocol {protocol} is asked for, but {PROTOCOL} is spoken here")
        try:
            return cls(Request(bytes([letter])), number)
        except ValueError:
            raise ProtocolError(f"request {chr(letter)!r} is not recognised") from None

    def written(self, identity: bytes = b"") -> bytes:
        """As bytes: of a request, or with the tree's identity of a reply."""
        return HEADER.pack(PROTOCOL, self.request.value[0], self.number) + identity


@dataclass(frozen=True)
class Hook:
    """A breakpoint as it is asked for and shown.

    Attributes:
        uid: of the node.
        position: on which side of it.
        enabled: whether it counts.
        once: removed when it has been passed.
    """

    uid: int
    position: Position
    enabled: bool = True
    once: bool = False

    @classmethod
    def read(cls, text: bytes) -> list[Hook]:
        """Those of a request: one, or a list of them.

        Raises:
            ProtocolError: it is no such text, or asks for something else than a breakpoint.
        """
        content = read_json(text)
        return [cls._of(each) for each in (content if isinstance(content, list) else [content])]

    @classmethod
    def _of(cls, content: Any) -> Hook:
        if _value(content, "mode", int) != BREAKPOINT:
            raise ProtocolError("what a node returns is not replaced here: `caretree run --inject` injects faults")
        uid, position = place(content)
        return cls(uid, position, _value(content, "enabled", bool), _value(content, "once", bool))

    def content(self) -> dict[str, object]:
        """As it is shown to who asks for all of them."""
        return {
            "enabled": self.enabled,
            "uid": self.uid,
            "mode": BREAKPOINT,
            "once": self.once,
            "desired_status": "SKIPPED",
            "position": int(self.position),
        }


@dataclass(frozen=True)
class Unlock:
    """The word to go on.

    Attributes:
        uid: of the node.
        position: of the breakpoint.
        remove: whether the breakpoint is removed.
    """

    uid: int
    position: Position
    remove: bool

    @classmethod
    def read(cls, text: bytes) -> Unlock:
        """That of a request.

        Raises:
            ProtocolError: it is none, or asks that the node return something else.
        """
        content = read_json(text)
        if _value(content, "desired_status", str) in ("SUCCESS", "FAILURE"):
            raise ProtocolError("what a node returns is not replaced here: go on with SKIPPED")
        return cls(*place(content), _value(content, "remove_when_done", bool))


def place(content: Any) -> tuple[int, Position]:
    """Node and side that a request names.

    Raises:
        ProtocolError: it names none.
    """
    try:
        return _value(content, "uid", int), Position(_value(content, "position", int))
    except ValueError:
        raise ProtocolError("position is 0, before the node, or 1, after it") from None


def read_json(text: bytes) -> Any:
    """The content of a request.

    Raises:
        ProtocolError: it is no JSON.
    """
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        raise ProtocolError("the second part of the request is no JSON") from None


def _value(content: Any, name: str, kind: type) -> Any:
    value = content.get(name) if isinstance(content, Mapping) else None
    if type(value) is not kind:
        raise ProtocolError(f"{name} is {value!r}, but {kind.__name__} is asked for")
    return value


def states_of(statuses: Iterable[tuple[int, int]]) -> bytearray:
    """Statuses of nodes, (uid, status) each, as they are sent; the status of the n-th is byte 3 n + 2."""
    return bytearray(b"".join(STATE.pack(uid, status) for uid, status in statuses))


def transition(seconds: float, uid: int, status: int) -> bytes:
    """A change of status, `seconds` after the recording began: 6 bytes of microseconds, uid, status."""
    return max(round(seconds * 1e6), 0).to_bytes(8, "little")[:6] + STATE.pack(uid, status)


def error_reply(sentence: str) -> list[bytes]:
    """The answer to what cannot be answered."""
    return [b"error", sentence.encode()]
