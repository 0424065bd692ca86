"""A task's own judge decides: for run, trials and the report."""

import json
from dataclasses import replace

import pytest
from caretree.sim.errors import CaretreeError, RecordError
from caretree.sim.evaluate.run_record import Judgement
from caretree.sim.record.record import RUN_FILE, TRUTH_FILE, read_run
from caretree.trees.campaign.trial import judge_run
from caretree.trees.report.page import build_report
from caretree.trees.run.judging import judge_and_keep, kept
from caretree.trees.run.task import load_task


def reached(record):
    """The goal of every test."""
    return Judgement(success=True, numbers={"frames": float(len(record.t))})


def missed(record):
    """The same, missed."""
    return Judgement(success=False, problems=("the cup fell",))


def broken(record):
    """A judge with an error."""
    raise ValueError("no idea")


@pytest.fixture
def task():
    return replace(load_task("wave"), judge=reached)


def test_what_the_judge_says_is_kept_and_counts_for_trials_and_report(task, make_record, tmp_path):
    directory = make_record(tmp_path / "run")
    assert judge_and_keep(replace(task, judge=missed), directory) == kept(read_run(directory))
    trial = judge_run(directory, 0)
    assert (trial.outcome, trial.reached, trial.succeeded) == ("success", False, False)
    assert "goal not reached (tree: success)" in trial.sentence()
    page = build_report(directory)
    assert "goal not reached" in page
    assert "the cup fell" in page
    assert judge_and_keep(task, directory).success
    assert judge_run(directory, 0).succeeded


def test_a_judge_that_fails_has_found_no_success(task, make_record, tmp_path):
    directory = make_record(tmp_path / "run")
    with pytest.raises(CaretreeError, match="ValueError: no idea"):
        judge_and_keep(replace(task, judge=broken), directory)
    assert not judge_run(directory, 0).succeeded


def test_a_world_without_truth_is_not_judged(task, make_record, tmp_path):
    directory = make_record(tmp_path / "run")
    (directory / TRUTH_FILE).unlink()
    assert judge_and_keep(task, directory) is None
    assert kept(read_run(directory)) is None


@pytest.mark.parametrize("found", [3, {}, {"success": True, "problems": ["x"], "numbers": {}}])
def test_a_damaged_judgement_is_told(make_record, tmp_path, found):
    directory = make_record(tmp_path / "run")
    (directory / RUN_FILE).write_text(json.dumps(read_run(directory) | {"judgement": found}))
    with pytest.raises(RecordError):
        kept(read_run(directory))
