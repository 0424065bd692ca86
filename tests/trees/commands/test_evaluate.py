"""`caretree evaluate` says dressed or not, by its exit status too."""

import argparse
import json

import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.evaluate.unharmed_rows import ROWS
from caretree.trees.commands.evaluate import add_parser


def evaluate(*arguments: str) -> int:
    parser = argparse.ArgumentParser()
    add_parser(parser.add_subparsers())
    args = parser.parse_args(["evaluate", *arguments])
    return args.main(args)


def test_dressed_and_not(make_record, tmp_path, capsys):
    directory = make_record(tmp_path / "run")
    assert evaluate(str(directory)) == 0
    assert capsys.readouterr().out == "dressed, unharmed\n"
    with np.load(directory / "truth.npz") as stored:
        arrays = {name: stored[name] for name in stored.files}
    arrays["gripper_closed"][-1] = True
    np.savez(directory / "truth.npz", **arrays)
    assert evaluate(str(directory), "--json") == 1
    verdict = json.loads(capsys.readouterr().out)
    assert verdict["problems"] == ["a gripper still holds cloth in the last 2 s"]
    assert verdict["agrees"] is False
    assert verdict["unharmed"] is True


def test_harmed_and_unknown(make_record, tmp_path, capsys):
    directory = make_record(tmp_path / "run")
    with np.load(directory / "truth.npz") as stored:
        arrays = {name: stored[name] for name in stored.files}
    np.savez(directory / "truth.npz", **(arrays | {"bed_top": np.array(-0.5)}))
    assert evaluate(str(directory)) == 1
    head, *problems = capsys.readouterr().out.splitlines()
    assert head == "NOT dressed, HARMED"
    assert [problem.split(" ends ")[0] for problem in problems] == ["  - the left wrist", "  - the right wrist"]
    for name in ROWS:
        arrays.pop(name)
    np.savez(directory / "truth.npz", **arrays)
    assert evaluate(str(directory)) == 0
    assert capsys.readouterr().out == "dressed, unharmed: unknown\n"


def test_unreadable_is_one_sentence(tmp_path):
    with pytest.raises(CaretreeError, match="is not a folder"):
        evaluate(str(tmp_path / "nowhere"))


def test_an_edited_record_is_to_blame_and_not_the_task(make_record, tmp_path):
    directory = make_record(tmp_path / "run")
    run = json.loads((directory / "run.json").read_text())
    (directory / "run.json").write_text(json.dumps(run | {"task": "wipe_forearm", "parameters": {}}))
    with pytest.raises(CaretreeError, match=r"run/run\.json is damaged: it lacks the task's parameter 'arm'"):
        evaluate(str(directory))
    (directory / "run.json").write_text(json.dumps(run | {"task": "wipe_forearm", "seed": "x"}))
    with pytest.raises(CaretreeError, match=r"run/run\.json is damaged: seed is 'x'"):
        evaluate(str(directory))
