"""`--robot` chooses what a task is rehearsed with; what skills cannot move ends in one sentence."""

import json

import pytest
from caretree.trees.cli import main

ONE_ARM = """
from dataclasses import replace
from caretree.sim.robot.baxter import BAXTER

ARM = replace(BAXTER, name="one-armed", arms=("right",))
"""


def refused(capsys, *words):
    assert main(list(words)) == 2
    return capsys.readouterr().err.strip()


def test_two_ur5_arms_wave(tmp_path):
    out = tmp_path / "run"
    assert main(["run", "wave", "--world", "scripted", "--robot", "ur5-pair", "--out", str(out)]) == 0
    parameters = json.loads((out / "run.json").read_text())["parameters"]
    assert parameters["robot"] == "ur5-pair"
    assert main(["replay", str(out)]) == 0


def test_wave_is_proven_for_them_too(capsys):
    assert main(["check", "wave", "--robot", "ur5-pair"]) == 0
    assert "wave holds" in capsys.readouterr().out


@pytest.mark.no_cover  # counting lines doubles its time
def test_the_dressing_is_proven_for_them_and_succeeds_on_its_scripted_world(capsys):
    assert main(["check", "dressing", "--robot", "ur5-pair"]) == 0
    said = capsys.readouterr().out
    assert "dressing holds" in said
    assert "on its scripted world it ends" not in said


def test_a_robot_with_one_arm_ends_in_one_sentence(tmp_path, monkeypatch, capsys):
    (tmp_path / "one_armed.py").write_text(ONE_ARM)
    monkeypatch.syspath_prepend(tmp_path)
    said = refused(capsys, "run", "wave", "--world", "scripted", "--robot", "one_armed:ARM")
    assert said.endswith("the robot one-armed has one arm, but the skills move two, left and right")
    assert len(said.splitlines()) == 1


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--robot", "atlas", "--world", "scripted"], "unknown robot 'atlas'; there are baxter, ur5-pair"),
        (
            ["--robot", "ur5-pair", "--world", "ros1"],
            "--robot ur5-pair needs one of bullet, scripted: ros1 brings its own",
        ),
    ],
)
def test_what_cannot_be_is_refused(words, said, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert said in refused(capsys, "run", "wave", *words)
