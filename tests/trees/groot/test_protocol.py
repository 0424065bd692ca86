"""The bytes are those of BehaviorTree.CPP 4's groot2_protocol.h, and a viewer written by others reads them."""

import json
import struct

import btview.protocol.groot2 as theirs
import pytest
from btview.model import NodeStatus as TheirStatus
from btview.model import decode_status_byte
from caretree.trees.groot.protocol import (
    IDLE_AFTER,
    Header,
    Hook,
    NodeStatus,
    Position,
    ProtocolError,
    Request,
    Unlock,
    error_reply,
    states_of,
    transition,
)

HOOK = {"enabled": True, "uid": 3, "mode": 0, "once": False, "desired_status": "SKIPPED", "position": 1}
WORD = {"uid": 3, "position": 0, "desired_status": "SKIPPED", "remove_when_done": True}


def test_headers_are_the_documented_struct():
    request = Header(Request.FULL_TREE, 0x01020304)
    assert request.written() == b"\x02T\x04\x03\x02\x01"
    assert Header.read(request.written()) == request
    assert request.written(b"i" * 16) == request.written() + b"i" * 16


def test_a_viewer_written_by_others_reads_the_headers():
    written = Header(Request.STATUS, 4_000_000_000).written(bytes(range(16)))
    read = theirs.ReplyHeader.decode(written)
    assert (read.request.protocol, read.request.request_type, read.request.unique_id) == (2, ord("S"), 4_000_000_000)
    assert read.tree_uuid == bytes(range(16))
    asked = theirs.RequestHeader.new(theirs.RequestType.BLACKBOARD)
    assert Header.read(asked.encode()) == Header(Request.BLACKBOARD, asked.unique_id)


def test_a_viewer_written_by_others_reads_the_statuses():
    sent = states_of([(1, NodeStatus.RUNNING), (700, IDLE_AFTER + NodeStatus.FAILURE)])
    assert len(sent) == 6
    (first, running), (second, idle) = theirs.parse_status_buffer(bytes(sent))
    assert (first, second) == (1, 700)
    assert decode_status_byte(running).status is TheirStatus.RUNNING
    assert decode_status_byte(idle).status is TheirStatus.IDLE
    assert decode_status_byte(idle).previous is TheirStatus.FAILURE


def test_letters_are_those_of_the_header_file():
    assert {each.name: each.value for each in Request} == {
        "FULL_TREE": b"T",
        "STATUS": b"S",
        "BLACKBOARD": b"B",
        "INSERT": b"I",
        "REMOVE": b"R",
        "REACHED": b"N",
        "UNLOCK": b"U",
        "DUMP": b"D",
        "REMOVE_ALL": b"A",
        "DISABLE_ALL": b"X",
        "RECORD": b"r",
        "TRANSITIONS": b"t",
    }


def test_a_transition_is_nine_bytes():
    assert transition(1.5, 258, NodeStatus.SUCCESS) == (1_500_000).to_bytes(6, "little") + struct.pack("<HB", 258, 2)


def test_hooks_and_words_are_read():
    assert Hook.read(json.dumps(HOOK).encode()) == [Hook(3, Position.AFTER)]
    assert Hook.read(json.dumps([HOOK, HOOK | {"uid": 4, "once": True}]).encode())[1] == Hook(
        4, Position.AFTER, once=True
    )
    assert Hook(3, Position.AFTER).content() == HOOK
    assert Unlock.read(json.dumps(WORD).encode()) == Unlock(3, Position.BEFORE, True)


@pytest.mark.parametrize(
    ("part", "said"),
    [
        (b"", "wrong request header: 0 bytes"),
        (b"\x02T\x00\x00\x00", "5 bytes, but there are 6"),
        (b"\x01T\x00\x00\x00\x00", "protocol 1 is asked for, but 2"),
        (b"\x02z\x00\x00\x00\x00", "'z' is not recognised"),
    ],
)
def test_a_wrong_header_is_one_sentence(part, said):
    with pytest.raises(ProtocolError, match=said):
        Header.read(part)


@pytest.mark.parametrize(
    ("read", "content", "said"),
    [
        (Hook.read, b"{", "no JSON"),
        (Hook.read, b"[" * 100_000, "no JSON"),
        (Hook.read, b"7", "mode is None, but int is asked for"),
        (Hook.read, json.dumps(HOOK | {"uid": "3"}).encode(), "uid is '3', but int is asked for"),
        (Hook.read, json.dumps(HOOK | {"enabled": 1}).encode(), "enabled is 1, but bool"),
        (Hook.read, json.dumps(HOOK | {"position": 2}).encode(), "position is 0, before the node, or 1"),
        (Hook.read, json.dumps(HOOK | {"mode": 1}).encode(), "what a node returns is not replaced here"),
        (Unlock.read, json.dumps(WORD | {"desired_status": "SUCCESS"}).encode(), "go on with SKIPPED"),
    ],
)
def test_what_is_not_granted_is_one_sentence(read, content, said):
    with pytest.raises(ProtocolError, match=said):
        read(content)


def test_a_viewer_written_by_others_reads_an_error():
    assert theirs.is_error_reply(error_reply("no"))
    assert theirs.error_reply_message(error_reply("no")) == "no"
