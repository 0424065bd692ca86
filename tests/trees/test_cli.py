"""The command line as its user meets it."""

import errno
import json
import os
import re
import shlex
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest
from caretree.sim import faults, known_robots, world_kind
from caretree.sim.bullet import engines
from caretree.sim.record.file_lock import lock_file
from caretree.sim.record.recorder import Recorder
from caretree.sim.render import looks
from caretree.sim.scene import scene
from caretree.trees import cli
from caretree.trees.cli import main
from caretree.trees.run import worlds


@pytest.fixture(autouse=True)
def in_an_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_a_run_shows_progress_outcome_and_paths(tmp_path, capsys):
    assert main(["run", "wave", "--world", "scripted", "--seed", "3"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "    0.00 s > wave"
    assert lines[1].startswith("    0.00 s     > hand up: turns w1 by 0.60 rad")
    assert "success: The task is done." in lines
    assert "runs/wave-seed3/run.json" in lines
    record = json.loads((tmp_path / "runs/wave-seed3/run.json").read_text())
    assert (record["task"], record["seed"], record["world"], record["outcome"]) == ("wave", 3, "scripted", "success")
    assert record["parameters"]["world_kind"] == "easy"
    assert [stage["name"] for stage in record["stages"]] == ["wave", "hold"]
    assert len(record["trace_hash"]) == 64
    assert main(["run", "wave", "--world", "scripted", "--seed", "3"]) == 0
    assert json.loads((tmp_path / "runs/wave-seed3-2/run.json").read_text())["trace_hash"] == record["trace_hash"]


def test_a_failed_run_is_recorded_and_returns_1(tmp_path, capsys):
    assert (
        main(
            [
                "run",
                "wave",
                "--world",
                "scripted",
                "--inject",
                "dead_camera@hold still:start",
                "--inject",
                "occlusion@wait:start",
                "--out",
                "r",
            ]
        )
        == 1
    )
    out = capsys.readouterr().out
    assert "safe stop: A sensor gave nothing. [hold still]" in out
    assert re.search(r"^    3\.\d\d s ! dead_camera@hold still:start$", out, re.M)
    assert "   never ! occlusion@wait:start: the run did not come to that phase of that node" in out
    record = json.loads((tmp_path / "r/run.json").read_text())
    assert record["outcome"] == "safe_stop"
    assert record["parameters"]["inject"] == ["dead_camera@hold still:start", "occlusion@wait:start"]
    assert [stage["status"] for stage in record["stages"]] == ["success", "failure"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "required: COMMAND"),
        (["fly"], "invalid choice: 'fly'"),
        (["run"], "required: TASK"),
        (["run", "dance"], "unknown task 'dance'; there are"),
        (["run", "wave", "--seed", "-1"], "'-1' is no seed"),
        (["run", "wave", "--seed", "one"], "'one' is no seed: a whole number from 0"),
        (["run", "wave", "--seed", "4294967296"], "is no seed"),
        (["run", "wave", "--world", "mars"], "unknown world 'mars'; there are bullet, scripted, remote, ros1, or give"),
        (["run", "wave", "--world", "ros1", "--world-arg", "site=attic"], "no site 'attic'"),
        (["run", "wave", "--world", "scripted", "--gown", "red"], "--gown needs the bullet world"),
        (["run", "wave", "--world-kind", "heavy"], "unknown world kind 'heavy'; there are easy, hard"),
        (["inject", "wave", "--world-kind", "heavy"], "unknown world kind 'heavy'; there are easy, hard"),
        (["run", "wave", "--world", "scripted", "--inject", "slip"], "is not written FAULT@NODE:PHASE"),
        (["run", "wave", "--world", "scripted", "--inject", "occlusion@nobody:step"], "names no skill of this task"),
        (["run", "wave", "--world", "scripted", "--stage", "dress"], "task 'wave' has no stages that can be run"),
        (
            ["run", "dressing", "--world", "scripted", "--inject", "occlusion@left arm/lit:step"],
            "the nearest are 'left arm/lift'",
        ),
        (["run", "wave", "--world", "scripted", "--out", "a_file"], "a_file is a file, but a folder"),
        (
            ["run", "dressing", "--world", "scripted", "--stage", "spread-dress"],
            "no stage 'spread-dress'; there are take_down, lay, dress, spread, and spans such as take_down-lay",
        ),
        (["check", "dance"], "unknown task 'dance'"),
        (["inject", "wave", "--fault", "rain"], "unknown fault 'rain'; there are"),
        (["replay", "nowhere"], "nowhere is not a folder"),
        (["evaluate", "nowhere"], "nowhere"),
        (["trials", "dance", "-n", "1", "--world", "scripted"], "unknown task 'dance'"),
    ],
)
def test_a_users_mistake_is_one_sentence_and_status_2(arguments, said, capsys):
    Path("a_file").touch()
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert said in captured.err
    assert captured.err.startswith("caretree: ")
    assert captured.err.count("\n") == 1
    assert "Traceback" not in captured.err
    if arguments[:1] != ["trials"]:
        assert not list(Path("runs").glob("*"))  # nothing is left behind


def test_a_finished_record_is_not_overwritten(capsys):
    assert main(["run", "wave", "--world", "scripted", "--out", "r"]) == 0
    assert main(["run", "wave", "--world", "scripted", "--out", "r"]) == 2
    assert "already holds a finished run" in capsys.readouterr().err


def test_a_file_in_the_place_of_a_campaigns_folder_is_told(tmp_path, capsys):
    (tmp_path / "f").write_text("")
    assert main(["trials", "wave", "-n", "1", "--out", "f"]) == 2
    assert "f is a file, but a folder is asked for" in capsys.readouterr().err


def test_two_campaigns_do_not_write_one_folder(capsys):
    Path("i").mkdir()
    lock = lock_file(Path("i/inject.jsonl"))
    assert main(["inject", "wave", "--out", "i"]) == 2
    assert "another campaign is writing i/inject.jsonl" in capsys.readouterr().err
    os.close(lock)


def test_an_error_in_a_task_is_kept_with_its_traceback(tmp_path, capsys):
    (tmp_path / "bad.py").write_text("""
from caretree.skills.core.skill import Skill
from caretree.trees.nodes.decorators import FailSafe
from caretree.skills import Retreat


class Bad(Skill):
    def steps(self):
        raise ValueError("over here")
        yield


def build(context):
    return FailSafe("safely", Bad("bad", context), Retreat("let go", context, hand_distance=0.0, ready="never"))
""")
    assert main(["run", "bad.py", "--world", "scripted", "--out", "r"]) == 1
    assert "r/errors.log" in capsys.readouterr().out.splitlines()
    assert 'bad.py", line 9, in steps' in (tmp_path / "r/errors.log").read_text()


def test_a_world_that_keeps_time_says_where_it_went(tmp_path):
    (tmp_path / "timed.py").write_text("""
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.stopwatch import Stopwatch
from caretree.trees.tasks.wave import build


class Timed(ScriptedWorld):
    stopwatch = Stopwatch()
    stopwatch.wall.update(cameras=-3.0, physics=2.0, record=0.5)
    stopwatch.processor.update(cameras=-2.0, physics=1.0, record=0.5)


def scripted(seed):
    return Timed(seed=seed), None
""")
    assert main(["run", "timed.py", "--world", "scripted", "--out", "r"]) == 0
    run = json.loads((tmp_path / "r/run.json").read_text())
    assert set(run["timing"]) == set(run["processor_timing"]) == {"tree", "cameras", "physics", "record"}
    assert run["timing"]["tree"] > 3.0
    assert 2.0 < run["processor_timing"]["tree"] < 2.0 + run["processor_time_s"]


def test_a_terminal_without_accents_does_not_end_a_run(tmp_path):
    (tmp_path / "t.py").write_text("""
from caretree.skills import HoldStill, Retreat
from caretree.trees import FailSafe


def build(context):
    safe = Retreat("let go", context, hand_distance=0.0, ready="never")
    return FailSafe("safely", HoldStill("h\u00e4lt", context), safe)
""")
    command = [sys.executable, "-m", "caretree.trees.cli", "run", "t.py", "--world", "scripted", "--out", "r"]
    done = subprocess.run(command, capture_output=True, env={**os.environ, "PYTHONIOENCODING": "ascii"}, check=False)
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"h\\xe4lt" in done.stdout


@pytest.mark.parametrize("event", [0, 5])
def test_a_full_disk_is_one_sentence_and_loses_nothing(tmp_path, monkeypatch, capsys, event):
    class Full:
        def __init__(self, file):
            self.file, self.count = file, 0

        def write(self, line):
            self.count += 1
            if self.count > event:
                raise OSError(errno.ENOSPC, "No space left on device")
            return self.file.write(line)

        def flush(self):
            pass

        def close(self):
            self.file.close()

    made = Recorder.__init__

    def init(self, *args, **kwargs):
        made(self, *args, **kwargs)
        self._trace = Full(self._trace)

    monkeypatch.setattr(Recorder, "__init__", init)
    assert main(["run", "wave", "--world", "scripted", "--out", "r"]) == 2
    told = capsys.readouterr()
    assert told.err.startswith("caretree: the disk is full")
    assert told.err.count("\n") == 1
    assert "The record can no longer be written. [recorder] the disk is full" in told.out
    assert len((tmp_path / "r/trace.jsonl").read_text().splitlines()) == event
    record = json.loads((tmp_path / "r/run.json").read_text())
    assert record["outcome"] == "safe_stop"
    assert record["stopped_from_outside"]


def test_check_says_what_holds_and_what_does_not(tmp_path, capsys):
    assert main(["check", "wave"]) == 0
    assert "\nwave holds: " in capsys.readouterr().out
    (tmp_path / "bad.py").write_text("""
from caretree.skills import Retreat


def build(context):
    return Retreat("let go", context, hand_distance=0.0, ready="never")
""")
    assert main(["check", "bad.py"]) == 1
    out = capsys.readouterr().out
    assert "fault: let go: it moves the robot, but no FailSafe is above it" in out
    assert "bad.py does not hold" in out


def test_inject_keeps_rows_and_goes_on(tmp_path, capsys):
    assert main(["inject", "wave", "--fault", "occlusion", "--out", "i"]) == 0
    first = capsys.readouterr().out
    path = tmp_path / "i/inject.jsonl"
    whole = path.read_text()
    path.write_text("".join(whole.splitlines(keepends=True)[:4]) + '{"node": "cut sho')
    assert main(["inject", "wave", "--fault", "occlusion", "--out", "i"]) == 0
    second = capsys.readouterr().out
    assert first[first.index("node ") :] == second[second.index("node ") :]
    assert second.count("[") < first.count("[")


def test_a_sample_of_a_campaign_is_drawn_by_the_seed(capsys):
    assert main(["inject", "wave", "--sample", "3", "--seed", "2", "--out", "a"]) == 0
    assert main(["inject", "wave", "--sample", "3", "--seed", "2", "--out", "b"]) == 0
    rows = [Path(folder, "inject.jsonl").read_text() for folder in "ab"]
    assert rows[0] == rows[1]
    assert len(rows[0].splitlines()) == 3
    capsys.readouterr()
    assert main(["inject", "wave", "--sample", "0"]) == 2
    assert "--sample is 0, but at least 1" in capsys.readouterr().err


def test_gap_and_learn_are_handed_on_or_said_to_be_missing(monkeypatch, capsys):
    import types

    given = []
    monkeypatch.setitem(sys.modules, "caretree.learning.gap", types.ModuleType("caretree.learning.gap"))
    module = types.ModuleType("caretree.learning.gap.cli")
    module.main = lambda argv: given.append(argv) or 7
    monkeypatch.setitem(sys.modules, "caretree.learning.gap.cli", module)
    assert main(["gap", "run", "SET", "--out", "x"]) == 7
    assert given == [["run", "SET", "--out", "x"]]


def test_help_names_what_there_is():
    assert ", ".join(scene.GOWNS) == cli.GOWNS
    assert ", ".join(known_robots.ROBOTS) == cli.ROBOTS
    assert cli.WORLDS == worlds.WORLDS
    assert ", ".join(scene.PERSONS) == cli.PERSONS
    assert ", ".join(looks.LOOKS) == cli.LOOKS
    assert ", ".join(engines.ENGINES) == cli.ENGINES
    assert ", ".join(faults.FAULTS) == cli.FAULTS
    assert ", ".join(("easy", *(f"easy+{one}" for one in world_kind.DIFFICULTIES), "hard")) == cli.WORLD_KINDS


def test_help_is_instant_because_nothing_heavy_is_imported():
    code = (
        "import sys; from caretree.trees.cli import main\n"
        "try: main(['--help'])\n"
        "except SystemExit: pass\n"
        "heavy = {'numpy', 'scipy', 'pybullet', 'pinocchio', 'toppra', 'numba', 'cv2', 'matplotlib', 'torch', "
        "'av', 'py_trees'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"
    for command in ("run", "check", "inject", "replay", "trials", "evaluate", "gap", "learn"):
        assert command in done.stdout


def test_the_version_is_that_of_the_package(capsys):
    with pytest.raises(SystemExit) as end:
        main(["--version"])
    assert end.value.code == 0
    assert capsys.readouterr().out == f"caretree {metadata.version('caretree')}\n"


def test_a_task_with_faults_that_show_is_not_run_unless_told(tmp_path, capsys):
    (tmp_path / "unsafe.py").write_text("""
from caretree.skills import MoveJoint


def build(context):
    return MoveJoint("h", context, side="left", joint="w1", angle=0.1)
""")
    assert main(["run", "unsafe.py", "--world", "scripted", "--out", "r"]) == 2
    error = capsys.readouterr().err
    assert error.startswith("caretree: h: it moves the robot, but no FailSafe is above it; `caretree check unsafe.py`")
    assert not (tmp_path / "r").exists()
    assert main(["run", "unsafe.py", "--world", "scripted", "--unchecked", "--out", "r"]) == 0


def test_a_name_that_no_font_can_draw_ends_no_run(tmp_path, capsys):
    (tmp_path / "odd.py").write_text("""
from caretree.skills import HoldStill, Retreat
from caretree.trees import FailSafe


def build(context):
    hold = HoldStill("\\u6301\\u3064\\u202e\\ud800", context, seconds=0.1)
    return FailSafe("safely", hold, Retreat("let go", context, hand_distance=0.0, ready="never"))
""")
    assert main(["run", "odd.py", "--world", "scripted", "--out", "r"]) == 0
    assert "success: The task is done." in capsys.readouterr().out


def test_a_run_without_anything_to_print_to_is_a_run(tmp_path):
    """Services start programs with their output closed: Python has no stream there then."""
    program = f"{shlex.quote(sys.executable)} -m caretree run wave --world scripted --out r >&- 2>&-"
    assert subprocess.run(["sh", "-c", program], check=False).returncode == 0
    assert (tmp_path / "r/run.json").is_file()
