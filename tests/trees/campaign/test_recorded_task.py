"""The task of a record is found from anywhere, and told where it is another one by now."""

import json
from pathlib import Path

import pytest
from caretree.skills.core.skill import Skill
from caretree.trees.cli import main

TASK = """
from caretree.skills import HoldStill, Retreat
from caretree.trees import FailSafe


def build(context):
    hold = HoldStill("hold", context, seconds={seconds})
    return FailSafe("safely", hold, Retreat("let go", context, hand_distance=0.0, ready="never"))
"""
JUDGED = (
    TASK
    + """

def judge(record):
    raise NotImplementedError
"""
)


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path, monkeypatch):
    before = list(Skill.registry)
    for name in ("here", "elsewhere"):
        (tmp_path / name).mkdir()
    monkeypatch.chdir(tmp_path / "here")
    yield
    Skill.registry[:] = before


def recorded(text=TASK):
    Path("mine.py").write_text(text.format(seconds=0.5))
    main(["run", "mine.py", "--world", "scripted", "--out", "run"])
    return str(Path("run").resolve())


def test_a_run_is_replayed_from_another_folder(monkeypatch, capsys):
    run = recorded()
    monkeypatch.chdir("../elsewhere")
    assert main(["replay", run]) == 0
    assert "repeats exactly" in capsys.readouterr().out


def test_another_task_of_that_name_here_is_not_taken_for_it(monkeypatch):
    run = recorded()
    monkeypatch.chdir("../elsewhere")
    Path("mine.py").write_text(TASK.format(seconds=2.0))
    assert main(["replay", run]) == 0


def test_a_file_that_was_changed_since_is_told(capsys):
    run = recorded()
    Path("mine.py").write_text(TASK.format(seconds=2.0))
    assert main(["replay", run]) == 1
    assert f"task file {Path('mine.py').resolve()} has been changed since" in capsys.readouterr().out


def test_a_record_that_came_here_with_its_task_is_replayed_too(monkeypatch):
    run = recorded()
    Path("mine.py").rename("../elsewhere/mine.py")
    monkeypatch.chdir("../elsewhere")
    assert main(["replay", run]) == 0


@pytest.mark.parametrize("command", ["replay", "evaluate"])
def test_one_whose_task_is_gone_is_one_sentence(command, capsys):
    run = recorded(JUDGED)
    Path("mine.py").unlink()
    capsys.readouterr()
    assert main([command, run]) == 2
    told = capsys.readouterr().err
    assert told.startswith(f"caretree: the task file of this record is not at {Path('mine.py').resolve()} any more")
    assert told.count("\n") == 1


def test_a_task_of_the_package_is_known_by_its_name():
    main(["run", "wave", "--world", "scripted", "--out", "run"])
    assert not {"task_file", "task_hash"} & set(json.loads(Path("run/run.json").read_text())["parameters"])
