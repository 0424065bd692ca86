import json

import pytest
from caretree.sim.errors import CaretreeError
from caretree.trees.campaign.recorded import recorded
from caretree.trees.cli import main

RUN = {"task": "wave", "seed": 100, "world": "scripted", "outcome": "success"}


def write(directory, **changed):
    parameters = changed.pop("parameters", None)
    run = {**RUN, **({} if parameters is None else {"parameters": parameters}), **changed}
    (directory / "run.json").write_text(json.dumps(run))
    return directory


def test_what_is_not_recorded_is_what_was_usual(tmp_path):
    found = recorded(write(tmp_path))
    assert (found.task, found.seed, found.world, found.world_kind) == ("wave", 100, "scripted", "easy")
    assert (found.rate_hz, found.inject, found.stage, found.tuning, found.versions) == (15.0, (), None, {}, {})


def test_what_is_recorded_is_given_again(tmp_path):
    tuning = {"hold_still": {"seconds": 1.0}}
    given = {"inject": ["occlusion@wait:step"], "rate_hz": 20, "stage": "dress", "tuning": tuning}
    found = recorded(write(tmp_path, parameters=given, versions={"numpy": "1"}))
    assert (found.inject, found.rate_hz, found.stage) == (("occlusion@wait:step",), 20.0, "dress")
    assert (found.tuning, found.versions) == (tuning, {"numpy": "1"})


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("task", None),
        ("task", ""),
        ("seed", "x"),
        ("seed", -1),
        ("seed", 1e300),
        ("seed", True),
        ("seed", 2**32),
        ("world", 3),
        ("parameters", [1]),
        ("versions", 3),
        *[
            (f"parameters.{name}", value)
            for name, value in [
                ("rate_hz", "fast"),
                ("rate_hz", -1),
                ("rate_hz", 1e-300),
                ("rate_hz", 1e9),
                ("rate_hz", float("nan")),
                ("inject", [3]),
                ("inject", 5),
                ("tuning", [1]),
                ("tuning", {"hold_still": 3}),
                ("stage", 3),
                ("world_kind", 3),
                ("gown", 3),
            ]
        ],
    ],
)
def test_a_damaged_value_is_named(tmp_path, name, value, capsys):
    outer, _, inner = name.partition(".")
    directory = write(tmp_path, **{outer: {inner: value} if inner else value})
    (tmp_path / "trace.jsonl").write_text("")
    with pytest.raises(CaretreeError, match=rf"run.json is damaged: {inner or outer} is "):
        recorded(directory)
    assert main(["replay", str(tmp_path)]) == 2
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.parametrize("file", ["run.json", "trace.jsonl"])
@pytest.mark.parametrize("content", [b"[" * 100_000, b"\xff\xfe", b'{"seed": ' + b"9" * 5000 + b"}", b"3"])
def test_a_damaged_file_is_told_in_one_sentence(tmp_path, file, content, capsys):
    write(tmp_path)
    (tmp_path / "trace.jsonl").write_text("")
    (tmp_path / file).write_bytes(content + b"\n" + content)
    assert main(["replay", str(tmp_path)]) == 2
    assert capsys.readouterr().err.count("\n") == 1
