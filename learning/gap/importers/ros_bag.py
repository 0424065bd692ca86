"""Messages of a ROS 1 bag, format 2.0, without ROS: http://wiki.ros.org/Bags/Format/2.0."""

from __future__ import annotations

import bz2
import struct
from collections.abc import Iterator
from pathlib import Path

from ..errors import GapError

MAGIC = b"#ROSBAG V2.0\n"
MESSAGE, CHUNK, CONNECTION = 2, 5, 7  # kinds of records


def read_bag(path: Path) -> Iterator[tuple[str, str, bytes]]:
    """Topic, type and bytes of every message, in the order in which they lie in the file.

    Raises:
        GapError: it is no such bag, or is damaged.
    """
    data = path.read_bytes()
    if not data.startswith(MAGIC):
        raise GapError(f"{path}: is no ROS 1 bag of format 2.0")
    known: dict[bytes, tuple[str, str]] = {}
    try:
        for fields, content in _records(data, len(MAGIC)):
            inside = [(fields, content)]
            if fields[b"op"][0] == CHUNK:
                inside = list(_records(_unpacked(path, fields[b"compression"], content), 0))
            for each, body in inside:
                kind = each[b"op"][0]
                if kind == CONNECTION:
                    known[each[b"conn"]] = (each[b"topic"].decode(), _fields(body)[b"type"].decode())
                elif kind == MESSAGE:
                    yield *known[each[b"conn"]], body
    except (struct.error, KeyError, IndexError, ValueError, OSError) as error:
        raise GapError(f"{path}: the bag is damaged ({type(error).__name__}: {error})") from error


def _records(data: bytes, at: int) -> Iterator[tuple[dict[bytes, bytes], bytes]]:
    """Header and content of one record after the other."""
    while at < len(data):
        header, at = _sized(data, at)
        content, at = _sized(data, at)
        yield _fields(header), content


def _sized(data: bytes, at: int) -> tuple[bytes, int]:
    """Bytes with their count in front, and where they end."""
    size = struct.unpack_from("<I", data, at)[0]
    end = at + 4 + size
    if end > len(data):
        raise ValueError("it ends within a record")
    return data[at + 4 : end], end


def _fields(header: bytes) -> dict[bytes, bytes]:
    found, at = {}, 0
    while at < len(header):
        field, at = _sized(header, at)
        name, _, value = field.partition(b"=")
        found[name] = value
    return found


def _unpacked(path: Path, compression: bytes, content: bytes) -> bytes:
    if compression == b"none":
        return content
    if compression == b"bz2":
        return bz2.decompress(content)
    if compression == b"lz4":
        import lz4.frame

        return lz4.frame.decompress(content)
    raise GapError(f"{path}: a bag compressed with {compression.decode(errors='replace')} is not read")
