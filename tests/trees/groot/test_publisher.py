"""A run is served to viewers that others wrote, ends as it would unwatched, and leaves nothing behind."""

import contextlib
import json
import socket
import subprocess
import sys

import msgpack
import pytest
from btview.client import Groot2Client
from btview.model import NodeStatus
from btview.protocol.groot2 import ProtocolError
from caretree.sim.errors import CaretreeError
from caretree.trees.cli import main
from caretree.trees.groot.protocol import Request
from caretree.trees.groot.publisher import Publisher

from .conftest import free_port, until


@pytest.fixture
def viewer(served):
    client = Groot2Client(port=served.port, timeout_ms=30_000)
    yield client
    client.close()


def test_a_viewer_written_by_others_follows_a_run(served, viewer, groot, uid, unwatched):
    tree = viewer.fetch_tree()
    assert [node.name for node in tree.roots[0].walk()] == [
        "safely", "all", "up", "", "rest", "still", "down", "let go"
    ]  # fmt: skip
    assert {state.status for state in viewer.poll().statuses.values()} == {NodeStatus.IDLE}
    groot.hook(uid("still"))
    served.begin()
    assert groot.reached() == uid("still")
    states = viewer.poll().statuses
    said = {name: states[uid(name)].status.name for name in ("safely", "all", "up", "rest", "still", "down")}
    assert said == {
        "safely": "RUNNING", "all": "RUNNING", "up": "SUCCESS", "rest": "RUNNING", "still": "IDLE", "down": "IDLE"
    }  # fmt: skip
    assert states[uid("rest") - 1].status is NodeStatus.RUNNING  # the place where the stage's tree is put in
    assert viewer.fetch_blackboard(["RestStage"]) == {"RestStage": {"before": pytest.approx(0.0)}}
    groot.unlock(uid("still"))
    result = served.result()
    assert (result.outcome, result.trace_hash) == ("success", unwatched.trace_hash)
    states = viewer.poll().statuses
    assert {states[uid(name)].status for name in ("safely", "up", "rest", "still", "down")} == {NodeStatus.SUCCESS}
    assert states[uid("let go")].status is NodeStatus.IDLE


def test_a_node_that_was_stopped_is_idle_and_says_what_it_was(served, viewer, groot, uid):
    groot.hook(uid("down"), once=True)
    served.begin()
    groot.reached()
    served.run.request_stop()
    assert served.result().outcome == "safe_stop"
    states = viewer.poll().statuses
    assert (states[uid("up")].status, states[uid("up")].previous) == (NodeStatus.IDLE, NodeStatus.SUCCESS)


def test_changes_are_recorded_by_the_clock_of_the_world(served, groot, uid):
    (since,) = groot.ask(Request.RECORD, b"start")
    assert int(since) > 1_000_000_000_000_000  # [us] of the wall clock
    served.begin()
    end = served.result().sim_time_s
    (changes,) = groot.ask(Request.TRANSITIONS)
    told = [changes[k : k + 9] for k in range(0, len(changes), 9)]
    of_up = [(int.from_bytes(each[:6], "little"), each[8]) for each in told if each[6] == uid("up")]
    assert [status for _, status in of_up] == [NodeStatus.RUNNING, NodeStatus.SUCCESS]
    assert of_up[0][0] == 0
    assert 0.8 * end < int.from_bytes(told[-1][:6], "little") / 1e6 <= end  # it comes to rest after the last change
    assert groot.ask(Request.TRANSITIONS) == [b""]
    assert groot.ask(Request.RECORD, b"stop") == []


def test_the_whole_board_is_told_where_no_name_is_asked(served, groot):
    served.run.context.board.set("angle", 0.5)
    (packed,) = groot.ask(Request.BLACKBOARD, b"")
    assert msgpack.unpackb(packed) == {"Task": {"angle": 0.5}}
    (packed,) = groot.ask(Request.BLACKBOARD, b"RestStage;Nowhere")
    assert msgpack.unpackb(packed) == {"RestStage": {"angle": 0.5}}


def test_a_board_that_cannot_be_read_is_an_error_and_no_end(served, groot, monkeypatch):
    monkeypatch.setattr(served.run.context.board, "get", lambda name: 1 / 0)
    served.run.context.board.set("angle", 0.5)
    assert groot.ask(Request.BLACKBOARD, b"") == "ZeroDivisionError: division by zero"
    assert groot.ask(Request.STATUS)


@pytest.mark.parametrize("request_", [Request.INSERT, Request.BLACKBOARD, Request.UNLOCK, Request.RECORD])
def test_a_request_without_its_content_is_an_error(groot, request_):
    assert groot.ask(request_) == "must be 2 parts message"


def test_what_is_told_cannot_be_asked(groot):
    assert groot.ask(Request.REACHED, b"1") == "REACHED is told, not asked for"


def test_before_the_run_begins_there_is_no_tree():
    publisher = Publisher(port := free_port())
    client = Groot2Client(port=port, timeout_ms=30_000)
    with pytest.raises(ProtocolError, match="the run has not begun yet"):
        client.fetch_tree()
    client.close()
    publisher.close()


def test_closing_gives_the_ports_back_and_a_taken_one_is_one_sentence(served):
    with pytest.raises(CaretreeError, match=f"ports {served.port} and {served.port + 1} cannot be listened on"):
        Publisher(served.port)
    with pytest.raises(CaretreeError, match="cannot be listened on"):
        Publisher(served.port - 1)
    served.close()
    served.publisher = None
    Publisher(served.port).close()


def test_it_can_be_reached_from_this_machine_only(served):
    def reached(host):
        with socket.socket() as probe:
            return probe.connect_ex((host, served.port)) == 0

    assert reached("127.0.0.1")
    assert not reached("127.0.0.2")  # which a server on all addresses would answer


def test_without_pyzmq_one_sentence_says_how_to_install_it(monkeypatch, tmp_path, capsys):
    monkeypatch.setitem(sys.modules, "zmq", None)
    command = ["run", "wave", "--world", "scripted", "--out", str(tmp_path / "r")]
    assert main([*command, "--groot"]) == 2
    assert "--groot needs pyzmq and msgpack, which are not installed: pip install" in capsys.readouterr().err
    assert not (tmp_path / "r").exists()
    assert main([*command, "--groot", "70000"]) == 2
    assert "is no port" in capsys.readouterr().err


def test_nothing_is_loaded_unless_it_is_asked_for(tmp_path):
    code = (
        "import sys; from caretree.trees.cli import main; "
        f"main(['run', 'wave', '--world', 'scripted', '--out', {str(tmp_path / 'r')!r}]); "
        "sys.exit(any(name in sys.modules for name in ('zmq', 'msgpack', 'caretree.trees.groot')))"
    )
    assert subprocess.run([sys.executable, "-c", code], stdout=subprocess.DEVNULL, cwd=tmp_path).returncode == 0


def test_the_command_line_serves_the_wave_task(tmp_path):
    port = free_port()
    code = "import sys; from caretree.trees.cli import main; sys.exit(main(sys.argv[1:]))"
    command = [sys.executable, "-c", code, "run", "wave", "--world", "scripted", "--out", "r", "--groot", str(port)]
    client = Groot2Client(port=port, timeout_ms=30_000)
    names: list[str] = []

    def asked():
        with contextlib.suppress(ProtocolError):  # the run has not begun yet
            names[:] = [node.name for node in client.fetch_tree().walk()]
        return names

    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True) as run:
        assert run.stdout.readline() == f"Groot2 finds the tree at 127.0.0.1:{port}\n"
        until(asked)
        out, _ = run.communicate()
    client.close()
    assert "hand up" in names
    assert "success: The task is done." in out
    assert json.loads((tmp_path / "r/run.json").read_text())["outcome"] == "success"
