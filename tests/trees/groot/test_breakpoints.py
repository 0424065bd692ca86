"""A breakpoint holds the world still, and nothing that ends a run waits for it."""

import json
import re
import signal
import subprocess
import sys

import pytest
from caretree.trees.groot import breakpoints as module
from caretree.trees.groot.protocol import Request

from ..held_arm import FILE, put_down
from .conftest import Groot, free_port, until

AFTER = 1


def statuses(served, name):
    return [event["status"] for event in served.events if event.get("node", "").endswith("/" + name)]


def test_before_a_node_the_world_stands_still_until_it_is_let_go_on(served, groot, uid, unwatched):
    assert groot.hook(uid("still")) == []
    served.begin()
    assert groot.reached() == uid("still")
    stood = served.world.clock.now()
    assert stood > 0.0
    assert statuses(served, "still") == []
    for _ in range(20):
        groot.ask(Request.STATUS)
    assert (served.world.clock.now(), statuses(served, "still")) == (stood, [])
    assert groot.unlock(uid("still")) == []
    result = served.result()
    assert (result.outcome, result.trace_hash) == ("success", unwatched.trace_hash)
    assert result.timing["held"] > 0.0


def test_after_a_node_it_has_ended_and_the_next_has_not_begun(served, groot, uid):
    groot.hook(uid("still"), AFTER)
    served.begin()
    groot.reached()
    assert statuses(served, "still") == ["RUNNING", "SUCCESS"]
    assert statuses(served, "down") == []
    groot.unlock(uid("still"), AFTER)
    assert served.result().outcome == "success"


def test_a_node_is_held_once_each_time_that_it_begins_not_at_every_tick(served, groot, uid):
    groot.hook(uid("up"))
    served.begin()
    groot.reached()
    groot.unlock(uid("up"))
    assert served.result().outcome == "success"


def test_one_that_is_passed_once_is_gone(served, groot, uid):
    groot.hook(uid("up"), once=True)
    groot.hook(uid("down"))
    served.begin()
    groot.reached()
    groot.unlock(uid("up"))
    assert groot.reached() == uid("down")
    (hooks,) = groot.ask(Request.DUMP)
    assert [each["uid"] for each in json.loads(hooks)] == [uid("down")]
    groot.unlock(uid("down"), remove=True)
    assert served.result().outcome == "success"
    assert json.loads(groot.ask(Request.DUMP)[0]) == []
    assert not any("tick" in vars(node) for node in served.run.root.iterate())


@pytest.mark.parametrize(
    "go_on",
    [
        lambda groot, uid: groot.ask(Request.REMOVE, json.dumps({"uid": uid, "position": 0}).encode()),
        lambda groot, uid: groot.ask(Request.REMOVE_ALL),
        lambda groot, uid: groot.ask(Request.DISABLE_ALL),
        lambda groot, uid: groot.hook(uid, enabled=False),
    ],
    ids=["removed", "all removed", "all disabled", "disabled"],
)
def test_one_that_counts_no_more_lets_go_on(served, groot, uid, go_on):
    groot.hook(uid("still"))
    served.begin()
    groot.reached()
    assert go_on(groot, uid("still")) == []
    assert served.result().outcome == "success"


def test_a_run_that_is_told_to_stop_is_not_held(served, groot, uid):
    groot.hook(uid("still"))
    groot.hook(uid("let go"))
    served.begin()
    groot.reached()
    served.run.request_stop(detail="enough")
    result = served.result()  # the safe branch was not held either
    assert (result.outcome, "enough" in result.reason) == ("safe_stop", True)
    assert statuses(served, "let go")[-1] != "RUNNING"


def test_when_nobody_asks_any_more_the_run_goes_on(served, groot, uid, monkeypatch):
    groot.hook(uid("still"))
    served.begin()
    groot.reached()
    monkeypatch.setattr(module, "PATIENCE", 0.0)
    assert served.result().outcome == "success"


def test_the_end_of_the_server_lets_the_run_go_on(served, groot, uid):
    groot.hook(uid("still"))
    served.begin()
    groot.reached()
    served.publisher.close()
    assert served.result().outcome == "success"
    served.publisher = None


def test_a_long_pause_is_no_node_that_hangs(served, groot, uid, monkeypatch):
    groot.hook(uid("still"))
    served.begin()
    groot.reached()
    monkeypatch.setattr("caretree.trees.run.ticker.HANG", -1.0)
    assert not served.run.hangs()
    assert served.run._ticker.limit._ends == float("inf")
    groot.unlock(uid("still"))
    until(lambda: served.run._ticker.limit._ends < float("inf") or served.results)


def test_a_robot_is_not_held(served, groot, uid, monkeypatch):
    class WallClock:
        now, wait_until = served.world.clock.now, served.world.clock.wait_until

    monkeypatch.setattr(served.world, "clock", WallClock())
    assert groot.hook(uid("still")) == "a robot's time cannot be held: breakpoints are for simulated worlds"
    served.begin()
    assert served.result().outcome == "success"


def test_what_is_not_there_is_one_sentence(groot):
    assert groot.hook(99) == "there is no node 99; they are numbered from 1 to 8"
    assert groot.unlock(2) == "node 2 has no breakpoint there"
    assert groot.ask(Request.REMOVE, b'{"uid": 2, "position": 0}') == "node 2 has no breakpoint there"


def test_what_a_node_returns_is_not_replaced(served, groot, uid):
    assert groot.hook(uid("up"), mode=1).startswith("what a node returns is not replaced here")
    groot.hook(uid("up"))
    assert groot.unlock(uid("up"), status="SUCCESS").startswith("what a node returns is not replaced here")


def test_a_signal_ends_a_pause_in_the_safe_stop_that_puts_the_arm_down(tmp_path):
    port = free_port()
    command = [sys.executable, "-c", "import sys; from caretree.trees.cli import main; sys.exit(main(sys.argv[1:]))"]
    command += ["run", str(FILE), "--world", "scripted", "--out", "r", "--groot", str(port)]
    groot = Groot(port)
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as run:
        for line in run.stdout:
            if " > hold" in line:  # again and again, until somebody stops it
                break
        (xml,) = groot.ask(Request.FULL_TREE)
        uid = int(re.search(r'<Hold name="hold" _uid="(\d+)"', xml.decode()).group(1))
        groot.hook(uid)
        assert groot.reached() == uid
        run.send_signal(signal.SIGTERM)
        out, error = run.communicate()
    groot.close()
    assert (run.returncode, error) == (1, "")
    assert "safe stop: The operator interrupted the run." in out
    assert put_down([json.loads(line) for line in (tmp_path / "r" / "trace.jsonl").read_text().splitlines()])
