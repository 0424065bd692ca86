"""A log as a file: MCAP, which Foxglove and the public `mcap` reader open, with JSON messages."""

from __future__ import annotations

import contextlib
import json
import threading
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ..errors import RecordError
from ..extras import need
from .messages import Message
from .schemas import SCHEMAS

TOGETHER = 64  # writes that wait for each other: one after another they take half the time that each takes by itself


class LogFile:
    """One log; messages may come from several threads.

    The robot goes on where the disk does not: after the first error nothing more is written, and closing tells it.

    Args:
        path: of the file.

    Raises:
        MissingExtra: the package `mcap` is not installed.
        RecordError: the file is there already, or cannot be written.
    """

    def __init__(self, path: Path) -> None:
        need("mcap", "the log")
        import orjson
        from mcap.writer import Writer

        self._json = orjson.dumps  # writes null for a number that is none, and takes a tenth of the time of json
        self.path = path
        if path.exists():
            raise RecordError(f"{path} is there already: give another file with --log")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open("xb")
        except OSError as error:
            raise RecordError(f"{path} cannot be written: {error.strerror or error}") from error
        self._writer = Writer(self._file)
        self._writer.start(profile="", library="caretree")
        self._lock = threading.Lock()
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._counts: dict[str, int] = {}
        self._waiting: list[tuple[int, Iterable[Message]]] = []
        self._error: OSError | None = None
        self._closed = False

    def attach(self, name: str, media_type: str, text: str) -> None:
        """Put a text beside the messages."""
        with self._lock, self._told():
            self._writer.add_attachment(create_time=0, log_time=0, name=name, media_type=media_type, data=text.encode())

    def write(self, time: float, messages: Iterable[Message], *, at_once: bool = False) -> None:
        """Append messages.

        Args:
            time: of all of them [s].
            messages: asked for later, some writes together.
            at_once: they are asked for before this returns.
        """
        with self._lock:
            if self._error is None and not self._closed:
                self._waiting.append((max(0, round(time * 1e9)), messages))
                if at_once or len(self._waiting) >= TOGETHER:
                    self._write_waiting()

    def _write_waiting(self) -> None:
        waiting, self._waiting = self._waiting, []
        with self._told():
            for nanoseconds, messages in waiting:
                for topic, schema, content in messages:
                    self._counts[topic] = count = self._counts.get(topic, 0) + 1
                    self._writer.add_message(
                        channel_id=self._channel(topic, schema),
                        log_time=nanoseconds,
                        publish_time=nanoseconds,
                        sequence=count,
                        data=content.encode() if isinstance(content, str) else self._json(content),
                    )

    def close(self) -> None:
        """Finish the file; twice is once.

        Raises:
            RecordError: some of it could not be written.
        """
        with self._lock:
            if self._closed:
                return
            self._closed = True
            self._write_waiting()
            with self._told():
                if self._error is None:
                    self._writer.finish()
            with self._told():
                self._file.close()
        if self._error is not None:
            said = self._error.strerror or self._error
            raise RecordError(f"the log {self.path} is not whole: {said}") from self._error

    def _told(self) -> contextlib.AbstractContextManager[None]:
        return _Kept(self)

    def _channel(self, topic: str, schema: str) -> int:
        if topic not in self._channels:
            if schema not in self._schemas:
                text = json.dumps({"title": schema, **SCHEMAS[schema]})
                self._schemas[schema] = self._writer.register_schema(
                    name=schema, encoding="jsonschema", data=text.encode()
                )
            self._channels[topic] = self._writer.register_channel(
                topic=topic, message_encoding="json", schema_id=self._schemas[schema]
            )
        return self._channels[topic]

    def keep(self, error: OSError) -> None:
        """Remember the first error."""
        self._error = self._error or error


class _Kept(contextlib.AbstractContextManager[None]):
    """Keeps an error of the disk for the end, as the robot may hold a person's arm."""

    def __init__(self, log: LogFile) -> None:
        self._log = log

    def __exit__(self, kind: Any, error: BaseException | None, trace: Any) -> bool:
        if isinstance(error, OSError):
            self._log.keep(error)
            return True
        return False
