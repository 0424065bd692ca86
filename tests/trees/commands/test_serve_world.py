"""`caretree serve-world` offers a world, and `--world remote` runs a task on it."""

import json
import signal
import threading

import pytest
from caretree.sim.remote import world as remote
from caretree.sim.remote.server import WorldServer
from caretree.sim.scripted.world import ScriptedWorld
from caretree.trees.cli import main


@pytest.fixture
def served(monkeypatch, tmp_path):
    """Where each server of a test was found."""
    monkeypatch.chdir(tmp_path)
    found, ready = [], threading.Event()
    plain = WorldServer.__init__

    def init(self, *args, **options):
        plain(self, *args, **options)
        found.append(self.address)
        ready.set()

    monkeypatch.setattr(WorldServer, "__init__", init)
    return found, ready


def test_a_task_runs_on_a_world_that_is_served(served, tmp_path, capsys):
    found, ready = served
    statuses = []
    arguments = ["serve-world", "scripted", "--seed", "100", "--bind", "127.0.0.1:0", "--once"]
    thread = threading.Thread(target=lambda: statuses.append(main(arguments)))
    thread.start()
    assert ready.wait(60.0)
    run = ["run", "wave", "--world", "remote", "--world-arg", f"address={found[0]}", "--seed", "100", "--out", "r"]
    assert main(run) == 0
    thread.join(60.0)
    assert statuses == [0]
    record = json.loads((tmp_path / "r/run.json").read_text())
    assert record["world"] == "remote"
    assert record["parameters"]["world_args"] == {"address": found[0]}
    assert f"serving scripted at {found[0]}" in capsys.readouterr().out


def test_what_cannot_be_served_is_one_sentence(served, capsys):
    holder = WorldServer(ScriptedWorld())
    for arguments, said in (
        (["scripted", "--bind", "here"], "--bind is 'here', but HOST:PORT is asked for"),
        (["scripted", "--bind", holder.address], f"{holder.address} cannot be served: Address already in use"),
        (["moon"], "unknown world 'moon'"),
        (["scripted", "--stage", "dress"], "has no stages"),
    ):
        assert main(["serve-world", *arguments]) == 2
        told = capsys.readouterr().err
        assert said in told
        assert told.count("\n") == 1
    holder.close()


def test_the_usual_port_is_that_of_both_ends():
    assert f":{remote.PORT}" in remote.RemoteWorld.__init__.__defaults__[0]


def test_a_server_that_is_told_to_end_stops_its_robot(served, monkeypatch, tmp_path):
    """SIGTERM and SIGHUP used to end the process with the robot moving."""
    stopped = []
    monkeypatch.setattr(ScriptedWorld, "stop", lambda self: stopped.append(1))
    before = signal.getsignal(signal.SIGTERM)

    def told(self):
        try:
            signal.raise_signal(signal.SIGTERM)
        finally:
            self._stop_for_sure()

    monkeypatch.setattr(WorldServer, "serve_one", told)
    assert main(["serve-world", "scripted", "--bind", "127.0.0.1:0"]) == 130
    assert stopped
    assert signal.getsignal(signal.SIGTERM) is before
