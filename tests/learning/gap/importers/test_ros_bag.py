"""Bags put together here, as rosbag writes them: the format's page tells how."""

import bz2
import struct

import pytest
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.importers.joint_log import read_log
from caretree.learning.gap.importers.ros_bag import MAGIC, read_bag

TYPE = b"sensor_msgs/JointState"


def sized(data):
    return struct.pack("<I", len(data)) + data


def record(content, **fields):
    return sized(b"".join(sized(name.encode() + b"=" + value) for name, value in fields.items())) + sized(content)


def joint_state(t, names, *parts):
    """As ROS 1 sends it."""
    data = struct.pack("<III", 7, int(t), round(t % 1 * 1e9)) + sized(b"base")
    data += struct.pack("<I", len(names)) + b"".join(sized(name.encode()) for name in names)
    return data + b"".join(struct.pack(f"<I{len(part)}d", len(part), *part) for part in parts)


def bag(path, *, compression=b"none", pack=lambda data: data, kind=TYPE):
    conn = struct.pack("<I", 3)
    inside = record(sized(b"topic=/robot/joint_states") + sized(b"type=" + kind), op=b"\7", conn=conn, topic=b"/joints")
    for n in range(3):
        message = joint_state(5.0 + 0.5 * n, ["a", "b"], [0.1 * n, 1.0], [], [2.0, float(n)])
        inside += record(message, op=b"\2", conn=conn, time=bytes(8))
    header = record(b" " * 20, op=b"\3", index_pos=bytes(8), conn_count=b"\1\0\0\0", chunk_count=b"\1\0\0\0")
    chunk = record(pack(inside), op=b"\5", compression=compression, size=struct.pack("<I", len(inside)))
    path.write_bytes(MAGIC + header + chunk + record(bytes(12), op=b"\4", ver=b"\1\0\0\0", conn=conn))
    return path


def lz4(data):
    return pytest.importorskip("lz4.frame", reason="lz4 comes with mcap").compress(data)


@pytest.mark.parametrize(("compression", "pack"), [(b"none", bytes), (b"bz2", bz2.compress), (b"lz4", lz4)])
def test_joint_states_are_read(tmp_path, compression, pack):
    states = read_log(bag(tmp_path / "run.bag", compression=compression, pack=pack)).topics["/joints"]
    assert [state.t for state in states] == [5.0, 5.5, 6.0]
    assert states[2].position == {"a": 0.2, "b": 1.0}
    assert states[2].velocity == {}, "the robot does not tell"
    assert states[2].effort == {"a": 2.0, "b": 2.0}


def test_other_messages_are_left_alone(tmp_path):
    path = bag(tmp_path / "run.bag", kind=b"std_msgs/String")
    assert {kind for _, kind, _ in read_bag(path)} == {"std_msgs/String"}
    with pytest.raises(GapError, match="has no joint states"):
        read_log(path)


def test_what_is_no_bag_is_told(tmp_path):
    (tmp_path / "a.bag").write_text("hello")
    with pytest.raises(GapError, match=r"a\.bag: is no ROS 1 bag of format 2\.0"):
        read_log(tmp_path / "a.bag")


@pytest.mark.parametrize("size", [40, 90, 150, 300])
def test_a_bag_cut_short_is_damaged(tmp_path, size):
    path = bag(tmp_path / "run.bag")
    path.write_bytes(path.read_bytes()[:size])
    with pytest.raises(GapError, match="the bag is damaged"):
        read_log(path)


def test_an_unknown_compression_is_named(tmp_path):
    with pytest.raises(GapError, match="a bag compressed with zip is not read"):
        read_log(bag(tmp_path / "run.bag", compression=b"zip"))
