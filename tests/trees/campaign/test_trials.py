"""Campaigns keep what is finished, count as the paper does, and stop on bad input."""

import argparse
import json
import sys
import threading
from types import SimpleNamespace

import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.record.folder_claim import FolderClaim, FolderTakenError
from caretree.trees.campaign import trial as trial_module
from caretree.trees.campaign import trials as trials_module
from caretree.trees.campaign.running import Running
from caretree.trees.campaign.trial import InterruptedTrialError, judge_run, read_trial, run_trial
from caretree.trees.campaign.trials import Plan, run_trials
from caretree.trees.campaign.trials_table import table
from caretree.trees.commands.trials import add_parser, main, parse_seeds

# stands in for `caretree run`: seed 1 fails while dressing, 2 crashes, 9 is refused
CHILD = """
import json, pathlib, sys
args = sys.argv[1:]
assert args[:2] == ["run", "dressing"], args
seed, out = int(args[args.index("--seed") + 1]), pathlib.Path(args[args.index("--out") + 1])
with (out.parent.parent / "started.txt").open("a") as file:
    file.write(f"{seed} ")
if seed == 2:
    sys.exit("it broke")
if seed == 7:
    out.joinpath("run.json").write_text(json.dumps(dict(outcome="safe_stop", stopped_from_outside=True,
                                                        reason="The disk is full.")))
    print(f"{out}/run.json")
    sys.exit(2)
if seed == 8:  # its person is put down first
    import signal
    def end(*_):
        out.joinpath("run.json").write_text(json.dumps(dict(outcome="safe_stop", stopped_from_outside=True)))
        sys.exit(1)
    signal.signal(signal.SIGTERM, end)
    (out.parent.parent / "ready.txt").touch()
    signal.pause()
if seed == 6:  # somebody kills it, once
    import os, signal
    if (out.parent.parent / "started.txt").read_text().count("6") == 1:
        os.kill(os.getpid(), signal.SIGKILL)
if seed == 9:
    print("caretree: gown 'x' is unknown, but small is asked for")
    sys.exit(2)
names = ["take down", "lay it", "dress both arms", "spread it"]
if "--stage" in args:
    first, _, last = args[args.index("--stage") + 1].partition("-")
    stages = ["take_down", "lay", "dress", "spread"]
    names = names[stages.index(first):stages.index(last or first) + 1]
fails = seed == 1 and "dress both arms" in names
state = ["failure" if fails and name == "dress both arms" else "not_run" if fails and name == "spread it" else "success"
         for name in names]
out.joinpath("run.json").write_text(json.dumps(dict(
    task="dressing", seed=seed, world="scripted", outcome="failure" if fails else "success",
    reason="The sleeve is caught." if fails else "Done.", sim_time_s=10.0, wall_time_s=1.0,
    stages=[dict(name=name, status=status) for name, status in zip(names, state)])))
"""


@pytest.fixture
def fake_caretree(monkeypatch, tmp_path):
    script = tmp_path / "child.py"
    script.write_text(CHILD)
    monkeypatch.setattr(trial_module, "CARETREE", (sys.executable, "-S", str(script)))
    return tmp_path / "campaign"


def plan(directory, seeds=(0, 1, 2), **more) -> Plan:
    return Plan(task="dressing", seeds=seeds, directory=directory, **more)


def test_each_run_takes_one_thread(fake_caretree, monkeypatch):
    script = fake_caretree.parent / "child.py"
    script.write_text("import os, sys; sys.exit(os.environ['OMP_NUM_THREADS'] + os.environ['NUMBA_NUM_THREADS'])")
    monkeypatch.setenv("OMP_NUM_THREADS", "8")
    (trial,) = run_trials(plan(fake_caretree, seeds=(0,)), lambda text: None)
    assert trial.reason.endswith(": 11")


def test_table_counts_as_the_paper_does(fake_caretree):
    told: list[str] = []
    trials = run_trials(plan(fake_caretree, jobs=2), told.append)
    assert [trial.outcome for trial in trials] == ["success", "failure", "crash"]
    assert "it broke" in trials[2].reason
    run_trials(plan(fake_caretree, seeds=(0, 1), stage="dress"), told.append)
    run_trials(plan(fake_caretree, seeds=(2,), stage="lay"), told.append)
    run_trials(plan(fake_caretree, seeds=(0,), stage="dress-spread"), told.append)
    stored = json.loads((fake_caretree / "trials.json").read_text())
    counts = {
        row: {name: (rate["successes"], rate["trials"]) for name, rate in of_row.items()}
        for row, of_row in stored["table"].items()
    }
    assert counts == {
        "independent": {
            "take down": (0, 0),
            "lay it": (0, 0),
            "dress both arms": (1, 2),
            "spread it": (0, 0),
            "lay": (0, 1),  # it crashed before it recorded how the tree calls this stage
        },
        "overall": {
            "take down": (2, 2),
            "lay it": (2, 2),
            "dress both arms": (1, 2),
            "spread it": (1, 1),
            "lay": (0, 0),
            "overall": (1, 3),
        },
    }
    text = (fake_caretree / "table.txt").read_text()
    assert "independent trials" in text
    assert "overall: seed 1 failure (10 s simulated in 1 s): The sleeve is caught." in text
    assert "[2/3]" in "\n".join(told)


def test_finished_trials_are_not_run_again(fake_caretree):
    run_trials(plan(fake_caretree, seeds=(0,)), lambda line: None)
    told: list[str] = []
    run_trials(plan(fake_caretree, seeds=(0, 1)), told.append)
    assert (fake_caretree / "started.txt").read_text().split() == ["0", "1"]
    assert told[0] == "1 of 2 trials are there already"


def test_run_that_ended_before_it_was_judged_is_judged_now(fake_caretree):
    run_trials(plan(fake_caretree, seeds=(0,)), lambda line: None)
    (fake_caretree / "overall" / "seed-0000" / "trial.json").unlink()
    run_trials(plan(fake_caretree, seeds=(0,)), lambda line: None)
    assert (fake_caretree / "started.txt").read_text().split() == ["0"]


def test_interrupt_keeps_what_is_done_and_goes_on(fake_caretree):
    def interrupt(line: str) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_trials(plan(fake_caretree, seeds=(0, 1, 3)), interrupt)
    assert read_trial(fake_caretree / "overall" / "seed-0000") is not None
    assert len(run_trials(plan(fake_caretree, seeds=(0, 1, 3)), lambda line: None)) == 3


def test_a_run_that_is_stopped_from_outside_counts_for_nothing(fake_caretree):
    with pytest.raises(CaretreeError, match=r"the run in .*seed-0007 was stopped: The disk is full"):
        run_trials(plan(fake_caretree, seeds=(7,)), lambda line: None)
    assert read_trial(fake_caretree / "overall" / "seed-0007") is None
    with pytest.raises(CaretreeError, match="was stopped"):  # it runs again, as if it had never been
        run_trials(plan(fake_caretree, seeds=(7,)), lambda line: None)
    assert (fake_caretree / "started.txt").read_text().split() == ["7", "7"]


def test_an_interrupted_campaign_lets_its_runs_end_in_the_safe_stop(fake_caretree, monkeypatch):
    ready, folder = fake_caretree / "ready.txt", fake_caretree / "overall" / "seed-0008"
    stop = threading.Event()
    monkeypatch.setattr(stop, "is_set", ready.exists)
    with pytest.raises(InterruptedTrialError):
        run_trial("dressing", 8, folder, (), patience=60.0, stop=stop)
    assert json.loads((folder / "run.json").read_text())["outcome"] == "safe_stop"
    assert read_trial(folder) is None


def test_refused_input_ends_the_campaign_with_the_sentence(fake_caretree):
    with pytest.raises(CaretreeError, match=r"^gown 'x' is unknown"):
        run_trials(plan(fake_caretree, seeds=(9,)), lambda line: None)


def test_campaigns_do_not_mix(fake_caretree):
    run_trials(plan(fake_caretree, seeds=(0,)), lambda line: None)
    with pytest.raises(CaretreeError, match=r"holds trials of caretree run dressing, not of .*--gown small"):
        run_trials(plan(fake_caretree, seeds=(0,), arguments=("--gown", "small")), lambda line: None)
    (fake_caretree / "trials.json").write_text("{")
    with pytest.raises(CaretreeError, match="is damaged"):
        run_trials(plan(fake_caretree, seeds=(0,)), lambda line: None)


def test_stuck_run_counts_as_timeout(monkeypatch, tmp_path):
    monkeypatch.setattr(trial_module, "CARETREE", (sys.executable, "-S", "-c", "import time; time.sleep(60)"))
    (trial,) = run_trials(plan(tmp_path, seeds=(0,), patience=0.1), lambda line: None)
    assert trial.outcome == "timeout"


def test_bullet_run_is_judged_by_its_geometry(make_record, tmp_path):
    directory = make_record(tmp_path / "run", seed=5)
    assert judge_run(directory, 5).dressed is True
    assert judge_run(directory, 5).unharmed is True
    (directory / "truth.npz").unlink()
    found = judge_run(directory, 5)
    assert found.dressed is False
    assert found.outcome == "success"
    assert "(tree: success)" in found.sentence()
    assert "disagree on seeds 5" in table({"overall": [found]})


@pytest.mark.parametrize(
    ("count", "seeds", "expected"),
    [
        (None, None, tuple(range(10))),
        (3, None, (0, 1, 2)),
        (None, "4-6", (4, 5, 6)),
        (2, "7,1", (7, 1)),
    ],
)
def test_seeds(count, seeds, expected):
    assert parse_seeds(count, seeds) == expected


@pytest.mark.parametrize(
    ("count", "seeds", "message"),
    [
        (0, None, "at least 1"),
        (None, "a-b", "A-B like 0-9"),
        (None, "5-3", "above B"),
        (4, "0-9", "names 10 seeds"),
        (None, "0-99999999999", "at most 100000 trials"),
        (10**12, None, "at most 100000 trials"),
        (None, "4294967296", "from 0 to 4294967295"),
        (None, "3,-1", "A-B like 0-9"),
    ],
)
def test_bad_seeds_are_one_sentence(count, seeds, message):
    with pytest.raises(CaretreeError, match=message):
        parse_seeds(count, seeds)


@pytest.mark.parametrize("bad", [{"seeds": ()}, {"seeds": (1, 1)}, {"seeds": (-1,)}, {"seeds": (0,), "jobs": 0}])
def test_bad_plans_are_refused(tmp_path, bad):
    with pytest.raises(CaretreeError, match="asked for"):
        Plan(task="dressing", directory=tmp_path, **bad)


def test_command_line(fake_caretree, capsys):
    parser = argparse.ArgumentParser()
    add_parser(parser.add_subparsers())
    to_runs = ["--world-kind", "hard", "--gown", "small", "--inject", "stale@lift:step", "--set", "lift_arm.duration=6"]
    args = parser.parse_args(["trials", "dressing", "-n", "2", "--out", str(fake_caretree), *to_runs])
    assert args.main is main
    assert main(args) == 0
    assert "1/2 = 50%" in capsys.readouterr().out
    assert json.loads((fake_caretree / "trials.json").read_text())["arguments"] == to_runs


def test_a_trial_that_another_campaign_runs_is_left_alone(fake_caretree):
    campaign = plan(fake_caretree, seeds=(0,))
    theirs = FolderClaim(campaign.folder(0))
    (campaign.folder(0) / "spool").write_text("their record", encoding="utf-8")
    with pytest.raises(FolderTakenError, match="another run is writing"):
        run_trials(campaign, lambda line: None)
    assert (campaign.folder(0) / "spool").exists()
    theirs.release()
    run_trials(campaign, lambda line: None)


def test_a_run_that_is_killed_loses_its_own_trial_only_and_runs_again(fake_caretree):
    told: list[str] = []
    trials = run_trials(plan(fake_caretree, seeds=(6, 0)), told.append)
    assert [trial.seed for trial in trials] == [0]
    assert "seed 6 was stopped and counts for nothing: SIGKILL" in told
    assert [trial.seed for trial in run_trials(plan(fake_caretree, seeds=(6, 0)), told.append)] == [6, 0]
    assert (fake_caretree / "started.txt").read_text().split() == ["6", "0", "6"]


def test_trials_of_other_sources_are_put_aside_and_run_again(fake_caretree):
    told: list[str] = []
    run_trials(plan(fake_caretree, seeds=(0, 3), key="old"), told.append)
    run_trials(plan(fake_caretree, seeds=(0,), key="new"), told.append)
    assert "1 trials are of other sources or versions: they are put aside and run again" in told
    assert read_trial(fake_caretree / "other-old/overall/seed-0000").key == "old"
    stored = json.loads((fake_caretree / "trials.json").read_text())
    assert [trial["seed"] for trial in stored["trials"]["overall"]] == [0], "seed 3 is of yesterday"
    assert (fake_caretree / "started.txt").read_text().split() == ["0", "3", "0"]


def test_a_folder_is_nobodys_when_its_first_run_is_refused(fake_caretree):
    with pytest.raises(CaretreeError, match="gown"):
        run_trials(plan(fake_caretree, seeds=(9,)), lambda line: None)
    assert not (fake_caretree / "trials.json").exists()
    run_trials(plan(fake_caretree, seeds=(0,), arguments=("--gown", "small")), lambda line: None)


def test_two_campaigns_share_a_folder(fake_caretree, monkeypatch):
    """The other one runs seed 0 and finishes it while this one waits."""
    both = plan(fake_caretree, seeds=(0, 1))
    (fake_caretree / "overall").mkdir(parents=True)
    theirs = Running(both.folder(0), "")

    def finish(seconds):
        both.folder(0).mkdir()
        found = dict(seed=0, outcome="success", reason="by the other", problems=[])
        (both.folder(0) / "trial.json").write_text(json.dumps(found))
        theirs.release()

    monkeypatch.setattr(trials_module, "time", SimpleNamespace(sleep=finish))  # not subprocess's
    trials = run_trials(both, lambda line: None)
    assert [(trial.seed, trial.reason) for trial in trials] == [(0, "by the other"), (1, "The sleeve is caught.")]
    assert (fake_caretree / "started.txt").read_text().split() == ["1"]


def test_a_folder_in_which_other_sources_are_at_work_is_refused(fake_caretree):
    run_trials(plan(fake_caretree, seeds=(0,), key="old"), lambda line: None)
    theirs = Running(plan(fake_caretree).folder(5), "old")
    with pytest.raises(CaretreeError, match=r"another campaign works in .* runs seed-0005 there, of other sources"):
        run_trials(plan(fake_caretree, seeds=(0,), key="new"), lambda line: None)
    theirs.release()
