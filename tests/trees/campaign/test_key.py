"""The key of a campaign changes with whatever shapes a run, and with nothing else."""

import pytest
from caretree.trees.campaign import key as key_module
from caretree.trees.campaign.key import campaign_key, own_files, package_files
from caretree.trees.run.task import load_task

TASK = """import numbers_of_mine
from caretree.skills import Retreat
from caretree.trees import FailSafe


def build(context):
    return FailSafe("s", Retreat("a", context, hand_distance=0.0), Retreat("b", context, hand_distance=0.0))
"""


@pytest.fixture
def task(tmp_path):
    (tmp_path / "mine.py").write_text(TASK)
    (tmp_path / "numbers_of_mine.py").write_text("import deeper\nSPEED = 1\n")
    (tmp_path / "deeper.py").write_text("")
    (tmp_path / "unrelated.py").write_text("")
    return load_task(str(tmp_path / "mine.py"))


@pytest.mark.parametrize("name", ["mine.py", "numbers_of_mine.py", "deeper.py"])
def test_a_change_of_the_task_or_of_what_it_imports_is_another_key(task, tmp_path, name):
    before = campaign_key(task, ())
    (tmp_path / name).write_text((tmp_path / name).read_text() + "# changed\n")
    assert campaign_key(task, ()) != before


def test_what_the_task_does_not_name_is_not_in_its_key(task, tmp_path):
    before = campaign_key(task, ())
    (tmp_path / "unrelated.py").write_text("# changed\n")
    assert campaign_key(task, ()) == before


def test_arguments_files_they_name_and_versions_are_in_the_key(task, tmp_path, monkeypatch):
    tuning = tmp_path / "tuning.yaml"
    tuning.write_text("a: {b: 1}")
    plain, tuned = campaign_key(task, ()), campaign_key(task, ("--tuning", str(tuning)))
    tuning.write_text("a: {b: 2}")
    keys = {plain, tuned, campaign_key(task, ("--tuning", str(tuning))), campaign_key(task, ("--gown", "small"))}
    monkeypatch.setattr(key_module, "versions", lambda: {"numpy": "0"})
    assert len(keys | {campaign_key(task, ())}) == 5


def test_of_the_package_only_what_shapes_a_run_is_in_the_key():
    names = {path.relative_to(key_module.PACKAGE).as_posix() for path in package_files()}
    assert {"trees/tasks/wave.py", "skills/lift_arm.py", "sim/world.py", "trees/run/runner.py"} <= names
    assert not {name for name in names if name.startswith(("trees/report", "trees/campaign", "learning"))}
    assert own_files(load_task("wave").file) == []
