"""The record that an ONNX file bears, read without a package for ONNX.

A file is a protobuf message, and a message is a row of fields: a key, which is a number and a type, and a value.  Field
14 of the outermost message holds one property: its name in field 1, its text in field 2.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from .errors import CaretreeError


def read_properties(path: str | Path) -> dict[str, str]:
    """Name -> text of all that an ONNX file says about itself.

    Raises:
        CaretreeError: it is not there, or is no such file.
    """
    path = Path(path)
    try:
        data = path.read_bytes()
        pairs = [dict(_fields(value)) for number, value in _fields(data) if number == 14]
        return {pair[1].decode(): pair[2].decode() for pair in pairs}
    except (OSError, IndexError, KeyError, ValueError) as error:
        raise CaretreeError(f"{path}: this is no network in an ONNX file") from error


def _fields(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Number and bytes of every field of a message; numbers are left out.

    Raises:
        ValueError: this is no message.
    """
    at = 0
    while at < len(data):
        key, at = _number(data, at)
        kind = key & 7
        if kind == 0:
            _, at = _number(data, at)
        elif kind == 2:
            length, at = _number(data, at)
            if at + length > len(data):
                raise ValueError("a field is longer than its message")
            yield key >> 3, data[at : at + length]
            at += length
        elif kind in (1, 5):
            at += 8 if kind == 1 else 4
        else:
            raise ValueError(f"there is no type {kind} of fields")


def _number(data: bytes, at: int) -> tuple[int, int]:
    """A number of seven bits a byte, and where the next field begins."""
    value = shift = 0
    while True:
        byte = data[at]
        value, shift, at = value | (byte & 127) << shift, shift + 7, at + 1
        if byte < 128:
            return value, at
