import json

import numpy as np
import pytest
from caretree.learning.physics.clips import generate
from caretree.learning.physics.clips.clip import Clip
from caretree.learning.physics.clips.dataset import Dataset
from caretree.sim.scene.gown import GOWNS
from caretree.sim.scene.gown_file import GownFile, write_gown
from caretree.trees.cli import main


@pytest.fixture(autouse=True)
def quick(monkeypatch, small_gown):
    monkeypatch.setattr(generate, "SHARD", 4)
    monkeypatch.setitem(GOWNS, "medium", small_gown)


def test_data_makes_a_dataset_and_says_how_far_it_is(tmp_path, capsys):
    command = ["learn", "physics", "data", str(tmp_path / "set"), "--classes", "2", "--per-class", "3"]
    assert main(command) == 0
    said = capsys.readouterr()
    assert "min left" in said.err
    assert said.out.strip() == str(tmp_path / "set")
    assert len(Dataset.load(tmp_path / "set")) == 6
    assert main(command) == 0
    assert "min left" not in capsys.readouterr().err  # nothing to do


def test_clip_renders_a_named_gown_and_a_gown_file(tmp_path, capsys):
    assert (
        main(
            [
                "learn",
                "physics",
                "clip",
                str(tmp_path / "a.npz"),
                "--engine",
                "fast",
                "--filmstrip",
                str(tmp_path / "a.png"),
            ]
        )
        == 0
    )
    file = write_gown(tmp_path / "g.yaml", GownFile(base="medium", values={"mass": 0.2}, intervals={}))
    assert main(["learn", "physics", "clip", str(tmp_path / "b.npz"), "--engine", "fast", "--gown", str(file)]) == 0
    one, other = (Clip.load(tmp_path / name) for name in ("a.npz", "b.npz"))
    assert np.nanmax(np.abs(one.depth - other.depth)) > 0.01
    assert (tmp_path / "a.png").stat().st_size > 5000
    assert str(tmp_path / "b.npz") in capsys.readouterr().out


def test_show_draws_clips_and_datasets(tmp_path):
    assert main(["learn", "physics", "clip", str(tmp_path / "a.npz"), "--engine", "fast"]) == 0
    assert main(["learn", "physics", "data", str(tmp_path / "set"), "--kind", "disturbed", "--per-class", "2"]) == 0
    assert (
        main(
            [
                "learn",
                "physics",
                "show",
                str(tmp_path / "a.npz"),
                str(tmp_path / "set"),
                "--out",
                str(tmp_path / "b.png"),
            ]
        )
        == 0
    )
    assert (tmp_path / "b.png").stat().st_size > 10000


def test_sensitivity_prints_its_table(tmp_path, capsys):
    assert main(["learn", "physics", "sensitivity", "--points", "1", "--out", str(tmp_path / "s.json")]) == 0
    assert "| mass |" in capsys.readouterr().out
    assert json.loads((tmp_path / "s.json").read_text())["gowns"] == 1


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["policies"], "`caretree learn` has no part 'policies', it has physics"),
        (["physics", "dance"], "has no command 'dance', it has data, clip"),
        (["physics", "data"], "the following arguments are required: DIR"),
        (["physics", "data", "x", "--kind", "blender"], "invalid choice: 'blender'"),
        (["physics", "data", "x", "--kind", "uniform", "--classes", "4"], "has no classes, 4 were asked for"),
        (["physics", "data", "x", "--jobs", "0"], "argument --jobs: '0', but a whole number of at least 1"),
        (["physics", "data", "x", "--per-class", "0"], "counts start at 1"),
        (["physics", "clip", "x.npz", "--gown", "silk"], "unknown gown 'silk'"),
        (["physics", "clip", "x.npz", "--gown", "silk.yaml"], "silk.yaml: there is no such gown file"),
        (["physics", "show", "x.npz", "--out", "x.png"], "x.npz: there is no such clip"),
        (["physics", "show", "x.npz", "--out", "x.png", "--clips", "0"], "--clips is 0, at least 1"),
        (["physics", "show", "x.npz", "--out", "s.xyz"], "'s.xyz' is no picture; it may end in .png,"),
        (["physics", "clip", "x.npz", "--filmstrip", "s"], "'s' is no picture; it may end in .png,"),
        (["pregrasp", "evaluate", "made", "--bullet", "-1"], "'-1' is no whole number"),
        (["pregrasp", "data", "made", "--seeds", "5-3"], "'5-3' ends before it begins; a span is written like 110-139"),
        (["physics", "sensitivity", "--points", "0"], "--points is 0, at least 1"),
    ],
)
def test_a_mistake_is_one_sentence_and_status_2(tmp_path, monkeypatch, capsys, arguments, sentence):
    monkeypatch.chdir(tmp_path)
    assert main(["learn", *arguments]) == 2
    error = capsys.readouterr().err
    assert sentence in error
    assert error.startswith("caretree: ")
    assert error.count("\n") == 1
    assert not list(tmp_path.iterdir())
