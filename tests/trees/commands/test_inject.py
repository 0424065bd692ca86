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
