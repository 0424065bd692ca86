"""Trials on a cluster: records come back, a lost worker loses its own trial, and the task's files go along."""

import json
import sys
from pathlib import Path

import pytest
from caretree.trees.campaign import on_cluster
from caretree.trees.campaign.trial import InterruptedTrialError, Trial
from caretree.trees.campaign.trials import Plan, run_trials

from ...fake_ray import FakeRay

TASK = """from caretree.skills import Retreat
from caretree.trees import FailSafe


def build(context):
    return FailSafe("s", Retreat("a", context, hand_distance=0.0), Retreat("b", context, hand_distance=0.0))
"""


@pytest.fixture
def ray(monkeypatch):
    """Runs nothing: a trial finds its task file, its tuning and a fresh folder, and succeeds."""

    def run_trial(task, seed, directory, arguments, *, patience, stop, key):
        assert "def build" in Path(task).read_text()
        assert Path(arguments[1]).read_text() == "a: {}"
        if seed == 3:
            raise InterruptedTrialError("seed 3 was stopped and counts for nothing: SIGKILL")
        directory.mkdir(parents=True)
        directory.with_name(f"{directory.name}.log").write_text("said")
        trial = Trial(seed=seed, key=key, outcome="success", reason="Done.")
        (directory / "trial.json").write_text(json.dumps(vars(trial) | {"problems": []}))
        return trial

    fake = FakeRay(cores=2)
    monkeypatch.setitem(sys.modules, "ray", fake)
    monkeypatch.setattr(on_cluster, "run_trial", run_trial)
    return fake


def test_records_come_back_and_what_was_lost_is_told(ray, tmp_path):
    (tmp_path / "mine.py").write_text(TASK)
    (tmp_path / "tuning.yaml").write_text("a: {}")
    arguments = ("--tuning", str(tmp_path / "tuning.yaml"))
    plan = Plan(
        task=str(tmp_path / "mine.py"),
        key="k",
        seeds=(0, 1, 2, 3),
        directory=tmp_path / "c",
        arguments=arguments,
        address="ray://x",
    )
    ray.killed = {1}
    told: list[str] = []
    trials = run_trials(plan, told.append)
    assert [trial.seed for trial in trials] == [0, 2]
    assert (tmp_path / "c/overall/seed-0002/trial.json").exists()
    assert (tmp_path / "c/overall/seed-0002.log").read_text() == "said"
    assert "seed 1 was lost and counts for nothing: The worker died unexpectedly." in told
    assert "seed 3 was stopped and counts for nothing: SIGKILL" in told
