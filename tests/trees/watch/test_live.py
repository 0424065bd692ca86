"""A run that is watched: shown, paused, stepped and stopped in a browser, and never broken by it."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.trees.cli import main
from caretree.trees.report.looks import Witness
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task
from caretree.trees.watch.live import LiveView
from caretree.trees.watch.server import open_server

from ..held_arm import FILE, put_down

pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")


@pytest.fixture
def watched():
    """A run of the held arm with a view, and a way to run it in a thread."""
    view = LiveView("held arm")
    task = load_task(str(FILE))
    world, senses = task.scripted(0)
    run = Run(task, world, senses=senses, before_tick=view.before_tick, on_progress=view.progress)
    view.follow(run, world, Witness())
    results = []
    thread = threading.Thread(target=lambda: results.append(run.run()))
    yield view, run, thread, results
    run.request_stop()
    if thread.ident:
        thread.join()
    view.close()


def until(holds):
    """Wait until something holds that another thread brings about."""
    ends = time.monotonic() + 60.0
    while not holds():
        assert time.monotonic() < ends
        time.sleep(0.01)


def test_a_pause_holds_the_world_still_and_a_step_lets_one_tick_pass(watched):
    view, run, thread, _ = watched
    view.controls.pause()
    thread.start()
    assert run.context.now() == 0.0
    for ticks in (1, 2, 3):
        view.controls.step()
        until(lambda ticks=ticks: run.context.now() == pytest.approx(ticks / 15.0))
    assert run.world.clock.now() == pytest.approx(3 / 15.0)


def test_the_result_is_the_same_watched_or_not(watched):
    view, _run, thread, results = watched
    thread.start()
    thread.join()
    view.finish(results[0].reason)
    task = load_task(str(FILE))
    world, senses = task.scripted(0)
    assert results[0].trace_hash == Run(task, world, senses=senses).run().trace_hash


def test_the_page_is_used_in_a_browser(watched, browse, tmp_path):
    view, run, thread, results = watched
    view.controls.pause()
    thread.start()
    page = browse(view.url)
    text = page.until(lambda text: "held arm" in text and "paused" in text and "0.0 s" in text)
    assert "forces on the hands" in text
    page.press("step")
    page.until(lambda text: "▶" in text and "0.1 s" in text)
    page.press("go on")
    page.until(lambda text: "1.0 s" not in text or "paused" not in text)
    until(lambda: run.guard.grip("left") == "arm" or results)
    page.press("pause")
    until(lambda: view.controls.paused or results)
    if not results:
        page.press("stop safely")
    thread.join()
    view.finish(results[0].reason)
    page.until(lambda text: "the run has ended" in text)
    assert results[0].outcome in ("safe_stop", "failure", "success")


def test_the_stop_button_puts_the_arm_down(watched, browse):
    view, run, thread, results = watched
    held = threading.Event()

    def hold(name, phase):
        if run.guard.grip("left") == "arm" and not held.is_set():
            view.controls.pause()
            held.set()

    run.context.observers.append(hold)
    thread.start()
    held.wait()
    browse(view.url).press("stop safely")
    thread.join()
    assert results[0].outcome == "safe_stop"
    assert "the stop button of the view was pressed" in results[0].reason
    assert put_down(run.trace.events)


def test_the_room_is_on_the_page(watched, browse):
    view, _, thread, _ = watched
    thread.start()
    thread.join()
    view.finish("done")
    page = browse(view.url)
    page.until(lambda text: "the run has ended" in text)
    import cv2

    ends = time.monotonic() + 60.0
    while time.monotonic() < ends:
        picture = cv2.imdecode(np.frombuffer(page.photograph(), np.uint8), cv2.IMREAD_COLOR)
        if picture[300:, :800].std() > 8:
            return
    raise AssertionError("nothing of the room shows")


def test_a_signal_ends_a_pause_in_the_safe_stop(tmp_path):
    command = [sys.executable, "-c", "import sys; from caretree.trees.cli import main; sys.exit(main(sys.argv[1:]))"]
    command += ["run", str(FILE), "--world", "scripted", "--view", "--out", "r"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as run:
        assert b"live view: http://127.0.0.1:" in run.stdout.readline()
        for line in run.stdout:
            if b" x hold" in line:
                break
        run.send_signal(signal.SIGTERM)
        out, error = run.communicate()
    assert (run.returncode, error) == (1, b"")
    assert b"look at it again: caretree view r" in out
    record = json.loads((tmp_path / "r" / "run.json").read_text())
    assert record["outcome"] == "safe_stop"
    assert put_down([json.loads(line) for line in (tmp_path / "r" / "trace.jsonl").read_text().splitlines()])


def test_a_port_that_is_taken_is_one_sentence():
    server = open_server("first", None)
    port = server.get_port()
    with pytest.raises(CaretreeError, match=f"port {port} cannot be listened on"):
        open_server("second", port)
    server.stop()


def test_without_viser_one_sentence_says_how_to_install_it(monkeypatch, tmp_path, capsys):
    monkeypatch.setitem(sys.modules, "viser", None)
    command = ["run", str(FILE), "--world", "scripted", "--out", str(tmp_path / "r")]
    assert main([*command, "--view"]) == 2
    assert "the view needs viser, which is not installed: pip install 'caretree[view]'" in capsys.readouterr().err
    assert not (tmp_path / "r").exists()
    assert main([*command, "--port", "8080"]) == 2
    assert "give --view too" in capsys.readouterr().err
    assert main([*command, "--view", "--port", "99999"]) == 2
    assert "is no port" in capsys.readouterr().err
