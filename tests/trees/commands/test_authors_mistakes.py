"""Mistakes of a task's author that a stranger made: one sentence each."""

from pathlib import Path

import pytest
from caretree.trees.cli import main

SKELETON = """
from caretree.skills import HoldStill, MoveJoint, Reason, Retreat, Skill, SkillFailure
from caretree.trees import Condition, FailSafe, Timeout, sequence

{more}

def build(context):
    body = sequence("body", {leaf})
    return FailSafe("safely", body, Retreat("back off", context))
"""
BAD = [
    ('Condition("c", lambda c: False, "GRASP_MISSED")', "", "is a Reason such as Reason.PRECONDITION"),
    ('Condition(lambda c: False, "c")', "", "takes its name, a text, and then its test"),
    ('Condition("c", lambda: False)', "", "is called with the context: too many positional arguments"),
    (r'HoldStill("red \x1b[31m", context)', "", r"'red \x1b[31m'; a name holds no control characters"),
    ("HoldStill(5, context)", "", "takes its name, a text, and then the context, not 5"),
    ('Timeout("t", HoldStill("h", context), seconds="x")', "", "must be a number above 0"),
    ('MoveJoint("m", context, side="left", joint="w1", angle=0.2, speed=-1.0)', "", "must be above 0"),
    ('Condition("c", asked)', "def asked(context):\n    exit(1)", "calls sys.exit(1)"),
    (
        'Own("o", context)',
        "class Own(Skill):\n    reasons = ('GRASP_MISSED',)\n    def steps(self):\n        yield",
        "Own.reasons is a tuple of Reason",
    ),
    (
        'Timeout("t", Own("o", context), seconds=0.5)',
        "class Own(Skill):\n    def steps(self):\n        while True:\n            yield\n"
        "    def cancel(self):\n        raise ValueError('in cancel')",
        "ValueError: in cancel",
    ),
]


def written(folder: Path, leaf: str, more: str = "") -> Path:
    file = folder / "task.py"
    file.write_text(SKELETON.format(leaf=leaf, more=more))
    return file


@pytest.mark.parametrize(("leaf", "more", "told"), BAD)
def test_the_check_tells_it_in_one_sentence(tmp_path, capsys, leaf, more, told):
    status = main(["check", str(written(tmp_path, leaf, more))])
    out, err = capsys.readouterr()
    assert status in (1, 2)
    assert told in out + err
    assert "Traceback" not in out + err


def test_a_reason_that_is_none_is_told_where_it_is_raised(tmp_path, capsys):
    more = "class Own(Skill):\n    def steps(self):\n        yield\n        raise SkillFailure('GRASP_MISSED', 'x')"
    assert main(["check", str(written(tmp_path, 'Own("o", context)', more))]) == 1
    assert "SkillFailure takes a Reason such as" in capsys.readouterr().out


def test_a_reason_that_a_skill_does_not_name_is_a_fault(tmp_path, capsys):
    more = "class Own(Skill):\n    reasons = (Reason.GRASP_MISSED,)\n    def steps(self):\n        yield\n"
    more += "        raise SkillFailure(Reason.NOTHING_SEEN, 'x')"
    assert main(["check", str(written(tmp_path, 'Own("o", context)', more))]) == 1
    assert "failed with NOTHING_SEEN, which the reasons of Own do not name" in capsys.readouterr().out


@pytest.mark.parametrize("port", ["name = Input(str)", "now = Input(float)", "status = Output(float)"])
def test_a_port_called_as_what_every_skill_has_is_told(tmp_path, capsys, port):
    more = f"class Own(Skill):\n    {port}\n    def steps(self):\n        yield"
    more = "from caretree.skills import Input, Output\n" + more
    assert main(["check", str(written(tmp_path, 'Own("o", context)', more))]) == 2
    assert "of its own, call the port otherwise" in capsys.readouterr().err


def test_faults_are_not_injected_into_what_run_refuses(tmp_path, capsys):
    file = written(tmp_path, 'HoldStill("w", context), HoldStill("w", context)')
    assert main(["inject", str(file), "--fault", "lost_command", "--out", str(tmp_path / "out")]) == 2
    assert "2 skills are called 'w'" in capsys.readouterr().err


def test_no_file_but_a_tree_is_written_over(tmp_path, capsys):
    file = written(tmp_path, 'HoldStill("w", context)')
    before = file.read_text()
    assert main(["export", "xml", str(file), "--out", str(file)]) == 2
    assert "there already" in capsys.readouterr().err
    assert file.read_text() == before
    for _ in range(2):  # a tree may be exported again
        assert main(["export", "xml", str(file), "--out", str(tmp_path / "task.xml")]) == 0


def test_a_scripted_world_without_its_senses_is_told(tmp_path, capsys):
    more = "from caretree.sim.scripted.world import ScriptedWorld\n"
    more += "def scripted(seed):\n    return ScriptedWorld(seed=seed)"
    assert main(["check", str(written(tmp_path, 'HoldStill("w", context)', more))]) == 2
    assert "scripted() gave ScriptedWorld, not (world, senses or None)" in capsys.readouterr().err
