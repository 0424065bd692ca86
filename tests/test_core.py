"""The core runs on numpy and py_trees alone: everything else that setup.cfg can bring is kept away from it here."""

import json
import subprocess
import sys

import pytest
from caretree.sim.extras import EXTRA_OF

BLOCKED = f"""
import sys
class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.partition('.')[0] in {sorted(EXTRA_OF)!r}:
            raise ModuleNotFoundError(f'No module named {{name!r}}', name=name)
sys.meta_path.insert(0, Blocked())
"""


def alone(code, folder):
    """What a fresh interpreter without the extras answers."""
    return subprocess.run(
        [sys.executable, "-c", BLOCKED + code], cwd=folder, capture_output=True, text=True, timeout=120, check=False
    )


def command(folder, *words):
    """`caretree WORDS` without the extras."""
    return alone(f"from caretree.trees.cli import main\nsys.exit(main({list(words)!r}))", folder)


CORE = """
import caretree.trees.run.runner, caretree.trees.run.task, caretree.trees.run.open_world, caretree.trees.run.tuning
import caretree.trees.proof.check, caretree.trees.guard.guard
import caretree.trees.nodes.composers, caretree.trees.nodes.decorators, caretree.trees.report.page
import caretree.trees.btcpp.builder, caretree.trees.btcpp.writer, caretree.trees.campaign.inject
import caretree.sim.record.recorder, caretree.sim.evaluate.verdict, caretree.sim.faults
from caretree.sim.scripted.world import ScriptedWorld
ScriptedWorld(seed=1).observe()
import caretree.skills as skills
for name in skills.__all__: getattr(skills, name)
import caretree.gap
"""


def test_the_core_imports_nothing_else(tmp_path):
    done = alone(CORE, tmp_path)
    assert done.returncode == 0, done.stderr


def test_the_block_keeps_packages_away(tmp_path):
    assert "No module named 'scipy'" in alone("import scipy", tmp_path).stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("check", "wave"), "wave holds"),
        (("skills",), "lift_arm"),
        (("export", "xml", "wave", "--out", "wave.xml"), ""),
        (("inject", "wave", "--sample", "4", "--out", "faults"), "inject.html"),
        (("trials", "wave", "-n", "2", "--world", "scripted", "--out", "trials"), "table.txt"),
        (("completion", "bash"), "caretree"),
    ],
)
def test_commands_of_the_core_run(words, said, tmp_path):
    done = command(tmp_path, *words)
    assert done.returncode == 0, done.stderr
    assert said in done.stdout


def test_a_task_is_begun_run_and_repeated(tmp_path):
    assert command(tmp_path, "new", "greet").returncode == 0
    done = command(tmp_path, "run", "greet.py", "--world", "scripted", "--out", "r")
    assert done.returncode == 0, done.stderr
    assert "pip install 'caretree[view]'" in done.stdout, "the page, which is drawn, is not"
    assert json.loads((tmp_path / "r/run.json").read_text())["outcome"] == "success"
    assert "repeats exactly" in command(tmp_path, "replay", "r").stdout
    assert "pip install 'caretree[view]'" in command(tmp_path, "report", "r").stderr


@pytest.mark.parametrize(
    ("words", "extra"),
    [
        (("run", "wave"), "sim"),
        (("run", "dressing", "--world", "scripted"), "sim"),
        (("run", "wave", "--world", "scripted", "--set", "side=right"), "yaml"),
        (("run", "wave", "--world", "scripted", "--view"), "view"),
        (("run", "wave", "--world", "scripted", "--groot"), "groot"),
        (("run", "wave", "--world", "ros1"), "ros"),
        (("view", "."), "view"),
        (("robot", "doctor"), "ros"),
        (("serve-world", "scripted"), "remote"),
        (("gap", "run", ".", "--out", "o"), "gap"),
    ],
)
def test_a_command_that_takes_more_names_its_extra(words, extra, tmp_path):
    done = command(tmp_path, *words)
    assert done.returncode == 2, done.stdout + done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert f"pip install 'caretree[{extra}]'" in done.stderr
    assert not list(tmp_path.glob("runs/*/run.json"))
