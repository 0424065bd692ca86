import json
from pathlib import Path

import pytest
from caretree.skills.core.skill import Skill
from caretree.trees.cli import main
from caretree.trees.commands.inject import read_rows

ROW = {"node": "wait", "phase": "step", "fault": "occlusion", "outcome": "success", "reason": "", "unsafe": ""}


@pytest.fixture(autouse=True)
def in_an_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    before = list(Skill.registry)
    yield
    Skill.registry[:] = before


def test_a_damaged_row_is_left_out_and_tried_again():
    damaged = ["[1]", "3", json.dumps({**ROW, "outcome": "great"}), json.dumps({**ROW, "node": 3}), "[" * 99999]
    lines = [json.dumps(ROW), *damaged]
    Path("rows").write_bytes("\n".join(lines).encode() + b"\n\xff\xfe{\n")
    assert [row.as_dict() for row in read_rows(Path("rows"))] == [ROW]


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
