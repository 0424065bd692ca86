"""One trial, one runner: the mark of a trial at work is a lock that dies with its holder."""

import subprocess
import sys

from caretree.trees.campaign import running as running_module
from caretree.trees.campaign.running import Running, others, read_running


def test_only_one_may_run_a_trial_until_it_lets_go(tmp_path):
    folder = tmp_path / "overall" / "seed-0003"
    first = Running(folder, "abc")
    assert first.mine
    assert not Running(folder, "abc").mine
    assert read_running(folder).key == "abc"
    first.release()
    first.release()
    assert read_running(folder) is None
    assert Running(folder, "abc").mine


def test_a_sign_of_life_is_written_from_time_to_time(tmp_path, monkeypatch):
    now = [100.0]
    monkeypatch.setattr(running_module.time, "time", lambda: now[0])
    held = Running(tmp_path / "overall" / "seed-0003", "abc")
    for now[0], told in ((102.0, 100.0), (106.0, 106.0)):
        held.beat()
        assert read_running(tmp_path / "overall" / "seed-0003").last == told


def test_a_campaign_of_another_key_is_told_and_one_that_was_killed_is_not(tmp_path):
    folder = tmp_path / "overall" / "seed-0003"
    held = Running(folder, "abc")
    assert others(tmp_path, "abc") == ""
    assert "runs seed-0003 there, of other sources or versions" in others(tmp_path, "xyz")
    held.release()
    code = "import os, sys, pathlib; from caretree.trees.campaign.running import Running\n"
    code += "held = Running(pathlib.Path(sys.argv[1]), 'abc'); os._exit(9)"
    subprocess.run([sys.executable, "-c", code, str(folder)], check=False)
    assert read_running(folder) is not None
    assert others(tmp_path, "xyz") == ""
    assert Running(folder, "xyz").mine
