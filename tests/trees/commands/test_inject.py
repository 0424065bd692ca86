import json
from pathlib import Path

import pytest
from caretree.skills.core.skill import Skill
from caretree.trees.cli import main
from caretree.trees.commands.inject import read_rows

PLACE = {"node": "wait", "phase": "step", "fault": "occlusion"}
ROW = {**PLACE, "outcome": "success", "reason": "", "unsafe": "", "time_to_safe": 3.0}


@pytest.fixture(autouse=True)
def in_an_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    before = list(Skill.registry)
    yield
    Skill.registry[:] = before


def test_a_damaged_row_is_left_out_and_tried_again():
    damaged = ["[1]", "3", json.dumps({**ROW, "outcome": "great"}), json.dumps({**ROW, "node": 3}), "[" * 99999]
    damaged += [json.dumps({**ROW, "time_to_safe": "soon"}), json.dumps({**ROW, "time_to_safe": True})]
    yesterday = json.dumps({**ROW, "key": "old"})
    lines = [json.dumps({**ROW, "key": "new"}), yesterday, *damaged]
    Path("rows").write_bytes("\n".join(lines).encode() + b"\n\xff\xfe{\n")
    assert [row.as_dict() for row in read_rows(Path("rows"), "new")] == [ROW]


def test_a_task_that_fails_without_a_fault_survives_none(capsys):
    Path("fails.py").write_text("""
from caretree.skills import MoveJoint, Retreat
from caretree.trees import Condition, FailSafe, sequence


def build(context):
    never = Condition("never", lambda context: False)
    move = MoveJoint("move", context, side="left", joint="w1", angle=0.1)
    return FailSafe("safely", sequence("s", never, move), Retreat("let go", context, hand_distance=0.0, ready="never"))
""")
    assert main(["inject", "fails.py", "--fault", "occlusion"]) == 1
    out = capsys.readouterr().out
    assert "without any fault the task already ends in" in out
    assert "were not reached: nothing is said of them" in out


def test_what_was_not_reached_is_told_apart(capsys):
    assert main(["inject", "wave", "--fault", "stale_frame"]) == 0
    assert "were not reached: nothing is said of them" in capsys.readouterr().out


def test_a_stage_is_tried_alone_and_drawn(capsys):
    Path("staged.py").write_text("""
from caretree.skills import HoldStill, Retreat
from caretree.trees import FailSafe, Stage, TaskStage, sequence

STAGES = {name: TaskStage(lambda context, name=name: Stage(name, None, HoldStill(f"hold {name}", context)))
          for name in ("one", "two")}


def build(context, stages=tuple(STAGES)):
    body = sequence("all", *(STAGES[name].build(context) for name in stages))
    return FailSafe("safely", body, Retreat("let go", context, hand_distance=0.0, ready="never"))
""")
    assert main(["inject", "staged.py", "--stage", "two", "--fault", "dead_sensor", "--out", "i"]) == 0
    out = capsys.readouterr().out
    assert "hold two" in out
    assert "hold one" not in out
    assert "i/inject.html" in out
    assert "hold two" in Path("i/inject.html").read_text()
    assert main(["inject", "staged.py", "--stage", "three", "--out", "j"]) == 2
    assert "no stage 'three'" in capsys.readouterr().err


INTERRUPTING = """
import os, signal
from pathlib import Path
from caretree.skills import HoldStill, Retreat
from caretree.skills.core.skill import Skill
from caretree.trees import FailSafe, sequence

CAMPAIGN = os.getpid()


class Look(Skill):
    commands = False

    def steps(self):
        if os.getpid() != CAMPAIGN and self.world.observe().time > 1.0 and not Path("interrupted").exists():
            Path("interrupted").touch()
            os.kill(CAMPAIGN, signal.SIG{signal})
            signal.pause()
        yield


def build(context):
    body = sequence("s", HoldStill("hold", context, seconds=2.0), Look("look", context))
    return FailSafe("safely", body, Retreat("let go", context, hand_distance=0.0, ready="never"))
"""


@pytest.mark.parametrize("name", ["INT", "TERM"])
def test_an_interrupted_campaign_of_two_jobs_ends_its_processes_and_goes_on(name, capsys):
    Path("presses.py").write_text(INTERRUPTING.replace("{signal}", name))
    words = ["inject", "presses.py", "--jobs", "2", "--fault", "dead_sensor", "--fault", "occlusion", "--out", "i"]
    assert main(words) == 130
    told = capsys.readouterr().out
    kept = len(Path("i/inject.jsonl").read_text().splitlines())
    assert f"interrupted; {kept} of 18 rows are kept" in told
    assert main(words) == 0
    told = capsys.readouterr().out
    assert f"18 faults to try, {kept} of them tried before" in told
    rows = [json.loads(line) for line in Path("i/inject.jsonl").read_text().splitlines()]
    assert len(rows) == 18
    assert "lost" not in told


def test_a_reader_of_the_output_that_has_gone_is_no_disk_that_fails(monkeypatch, capsys):
    Path("presses.py").write_text(INTERRUPTING.replace("{signal}", "INT"))
    Path("interrupted").touch()

    def gone(*words, **options):
        if str(words[0]).startswith("["):
            raise BrokenPipeError(32, "Broken pipe")

    monkeypatch.setattr("builtins.print", gone)  # `capsys` stands behind stdout, which is given up then
    words = ["inject", "presses.py", "--fault", "dead_sensor", "--fault", "occlusion", "--out", "i"]
    assert main(words) == 1
    assert Path("i/inject.jsonl").read_text().count("\n") == 7, "six were not reached, of which nothing is said"


def test_rows_of_a_killed_process_are_lost_and_tried_again(capsys):
    text = INTERRUPTING.replace("CAMPAIGN, signal.SIG{signal}", "os.getpid(), signal.SIGKILL")
    Path("dies.py").write_text(text)
    words = ["inject", "dies.py", "--fault", "occlusion", "--out", "i"]
    assert main(words) == 1
    assert "were lost with the process that tried them: the same command tries them again" in capsys.readouterr().out
    kept = len(Path("i/inject.jsonl").read_text().splitlines())
    assert kept < 9
    assert main(words) == 0
    assert f"9 faults to try, {kept} of them tried before" in capsys.readouterr().out


def test_no_job_is_refused(capsys):
    assert main(["inject", "wave", "--jobs", "0", "--out", "i"]) == 2
    assert "argument --jobs: '0', but a whole number of at least 1 is asked for" in capsys.readouterr().err
    assert not Path("i").exists()
