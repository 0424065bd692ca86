"""The walk through a new task works as it is written."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from caretree.sim.evaluate.run_record import RunRecord
from caretree.skills.core.skill import Skill
from caretree.trees.cli import main
from caretree.trees.run.task import load_task

PAGE = (Path(__file__).parents[2] / "docs/new-task.md").read_text(encoding="utf-8")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Where the reader of the page stands; what the task registers is forgotten afterwards."""
    before = list(Skill.registry)
    monkeypatch.chdir(tmp_path)
    yield tmp_path
    Skill.registry[:] = before


def replaced(text, block):
    """`text` with the functions of `block` in place of its own, and the other lines of `block` before the first one."""
    theirs = {each.name: each for each in ast.parse(text).body if isinstance(each, ast.FunctionDef)}
    lines = text.splitlines()
    mine = ast.parse(block).body
    functions = [each for each in mine if isinstance(each, ast.FunctionDef)]
    for each in sorted(functions, key=lambda each: -theirs[each.name].lineno):
        old = theirs[each.name]
        lines[old.lineno - 1 : old.end_lineno] = block.splitlines()[each.lineno - 1 : each.end_lineno]
    first = next(k for k, line in enumerate(lines) if line.startswith("def ") or line.startswith("class "))
    rest = [ast.unparse(each) for each in mine if not isinstance(each, ast.FunctionDef)]
    return "\n".join([*lines[:first], *rest, "", *lines[first:], ""])


def judged(moved):
    """Whether the task's judge is content with a left hand of which this has moved by 0.5 m for a while."""
    hands = np.zeros((10, 2, 7))
    moved(hands[:, 0])[5:8] += 0.5
    record = RunRecord.made_up(gripper_pose=hands, objects={"bottle": np.zeros((10, 7))})
    return load_task("offer.py").judge(record).success


def test_the_page_leads_to_a_task_that_holds_runs_and_passes_its_test(folder):
    commands = re.findall(r"^    (\S.*?)(?:  +#.*)?$", PAGE, re.MULTILINE)
    assert main(commands[1].split()[1:]) == 0
    assert commands[1] == "caretree new offer"
    ((old, new),) = re.findall(r"^    sed -i 's/(\w+)/(\w+)/g;", PAGE, re.MULTILINE)
    for path in (folder / "offer.py", folder / "test_offer.py"):
        path.write_text(path.read_text().replace(old, new).replace(old.upper(), new.upper()))
    (block,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    (folder / "offer.py").write_text(replaced((folder / "offer.py").read_text(), block))
    for command in ("caretree check offer.py", "caretree run offer.py --world scripted"):
        assert command in commands
        assert main(command.split()[1:]) == 0
    assert not judged(lambda hand: hand[:, :2]), "the base has driven and taken the hand along"
    assert judged(lambda hand: hand[:, 2:3])
    assert "pytest" in commands
    tested = subprocess.run([sys.executable, "-m", "pytest", "-q"], cwd=folder, capture_output=True, text=True)
    assert tested.returncode == 0, tested.stdout
