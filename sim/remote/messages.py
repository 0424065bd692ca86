"""Messages between a tree and a world in another process: msgpack, with arrays, one after the other.

A tree begins with `hello` and the version of its messages, and is told of the world; then it asks, one message each
`(what, values)`, and every message but `stop` is answered by `(error, answer, now)`: the name of an error or nothing,
the answer or the error's sentence, and the world's clock [s] afterwards.
"""

from __future__ import annotations

import socket
from typing import TYPE_CHECKING, Any

import numpy as np

from ..extras import later
from ..world import WorldError

if TYPE_CHECKING:
    import msgpack
else:
    msgpack = later("msgpack")

VERSION = 2
LARGEST = 64 * 2**20  # [bytes] of one message: an image of 12 million pixels
SENDING = 5.0  # [s] that the other end may take to take a message
CHUNK = 2**16  # [bytes]
ARRAY = 1  # msgpack's code of an array


class Connection:
    """One end of the line.

    Args:
        line: connected; closed with this.
    """

    def __init__(self, line: socket.socket) -> None:
        line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # a command waits for no other
        self._line = line
        self._unpacker = msgpack.Unpacker(use_list=False, ext_hook=_array, max_buffer_size=LARGEST)

    def send(self, message: Any) -> None:
        """Send one message of plain values; raises OSError where nobody is there, or takes it."""
        self._line.settimeout(SENDING)
        data: Any = msgpack.packb(message, default=_packed_array)
        self._line.sendall(data)

    def receive(self, patience: float | None = None) -> Any:
        """The next message.

        Args:
            patience: how long to wait for it [s]; None for ever.

        Raises:
            TimeoutError: nothing has come.
            EOFError: the other end has gone.
            WorldError: what came is no message.
        """
        self._line.settimeout(patience)
        while True:
            try:
                return next(self._unpacker)
            except StopIteration:
                pass
            except Exception as error:
                raise WorldError(f"what came over the line is no message: {error}") from error
            data = self._line.recv(CHUNK)
            if not data:
                raise EOFError("the other end has gone")
            try:
                self._unpacker.feed(data)
            except msgpack.BufferFull as error:
                raise WorldError("what came over the line is no message: it is too long") from error

    def close(self) -> None:
        """Hang up; twice is once."""
        self._line.close()


def _packed_array(value: Any) -> msgpack.ExtType:
    if not isinstance(value, np.ndarray) or value.dtype.kind not in "bifu":
        raise TypeError(f"{type(value).__name__} cannot be sent")
    head = (value.dtype.str, value.shape)
    return msgpack.ExtType(ARRAY, msgpack.packb((*head, np.ascontiguousarray(value).tobytes())))


def _array(code: int, data: bytes) -> np.ndarray:
    if code != ARRAY:
        raise ValueError(f"unknown kind of value {code}")
    kind, shape, numbers = msgpack.unpackb(data, use_list=False)
    if np.dtype(kind).kind not in "bifu":
        raise ValueError(f"an array of {kind}")
    return np.frombuffer(numbers, kind).reshape(shape).copy()
