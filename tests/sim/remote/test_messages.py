"""Values of the contract go over the line and come back the same; nothing else does."""

import socket

import numpy as np
import pytest
from caretree.sim.remote.messages import LARGEST, Connection
from caretree.sim.remote.values import UndeclaredError, packed, unpacked
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import JointTrajectory, WorldError


@pytest.fixture
def line():
    near, far = socket.socketpair(socket.AF_UNIX)
    ends = [Plain(near), Plain(far)]
    yield ends
    for end in ends:
        end.close()


class Plain(Connection):
    """Over a pair of sockets that know no TCP."""

    def __init__(self, line):
        class Quiet:
            def __getattr__(self, name):
                return (lambda *unused: None) if name == "setsockopt" else getattr(line, name)

        super().__init__(Quiet())
        self.line = line


def test_values_arrive_as_they_were(line):
    world = ScriptedWorld(seed=100)
    command = JointTrajectory(joints=("head_pan",), times=np.array((0.0, 1.0)), positions=np.array(((0.0,), (0.3,))))
    for value in (world.observe(), world.look("head"), world.room, command):
        line[0].send(packed(value))
        back = unpacked(line[1].receive(5.0))
        assert type(back) is type(value)
        for name, content in vars(value).items():
            other = getattr(back, name)
            np.testing.assert_array_equal(content, other) if isinstance(content, np.ndarray) else None
            assert isinstance(content, np.ndarray) or content == other
            assert not isinstance(content, np.ndarray) or (content.dtype == other.dtype and other.flags.writeable)


def test_messages_that_come_in_pieces_or_together_are_told_apart(line, monkeypatch):
    monkeypatch.setattr("caretree.sim.remote.messages.CHUNK", 100)
    line[0].send(("a", np.arange(300.0)))
    line[0].send(("b", ()))
    assert line[1].receive(5.0)[0] == "a"
    assert line[1].receive(5.0) == ("b", ())
    with pytest.raises(TimeoutError):
        line[1].receive(0.001)
    line[0].close()
    with pytest.raises(EOFError, match="has gone"):
        line[1].receive(5.0)


@pytest.mark.parametrize("data", [b"\xc1", b"\xc7\x01\x05x", b"\xd4\x01\x00", b"\xdd\xff\xff\xff\xff"])
def test_what_is_no_message_is_said(line, data):
    line[0].line.sendall(data + b"\xc1" * 8)
    with pytest.raises(WorldError, match="no message"):
        line[1].receive(5.0)


def test_an_array_of_objects_is_not_made(line):
    import msgpack

    line[0].line.sendall(msgpack.packb(msgpack.ExtType(1, msgpack.packb(("|O", (1,), b"12345678")))))
    with pytest.raises(WorldError, match="no message: an array of"):
        line[1].receive(5.0)
    with pytest.raises(TypeError, match="cannot be sent"):
        line[0].send(np.array([ScriptedWorld()], object))
    assert LARGEST > 2**20


def test_what_the_contract_does_not_declare_stays_here():
    with pytest.raises(UndeclaredError, match="ScriptedWorld"):
        packed(ScriptedWorld())
