import json
import shutil
from dataclasses import replace

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.clips.parameters import NAMES
from caretree.learning.physics.methods.examples import Loaded
from caretree.learning.physics.methods.weights import load_weights
from caretree.learning.physics.study import study as study_module
from caretree.learning.physics.study.evaluate import table, write_results
from caretree.learning.physics.study.figures import box_plot, learning_curves
from caretree.learning.physics.study.metrics import coverage, garment_error, median_interval
from caretree.learning.physics.study.registry import TITLES, Plan
from caretree.learning.physics.study.study import Study
from caretree.sim.errors import CaretreeError
from matplotlib.image import imread

from ..moving_blobs import blob_frames, blobs


def test_error_is_the_papers_mean_relative_error():
    true, estimated = np.array([[2.0, 10.0], [1.0, 1.0]]), np.array([[1.0, 11.0], [1.0, 1.5]])
    np.testing.assert_allclose(garment_error(true, estimated), [0.3, 0.25])
    np.testing.assert_allclose(garment_error(true, estimated, [1]), [0.1, 0.5])


def test_median_has_an_interval_that_narrows_with_clips():
    values = np.random.default_rng(0).exponential(size=2000)
    median, low, high = median_interval(values)
    assert low < np.log(2) < high
    assert low < median < high
    few = median_interval(values[:50])
    assert few[2] - few[1] > 2 * (high - low)


def test_coverage_counts_each_parameter():
    true, lower, upper = np.full((4, 2), 0.5), np.zeros((4, 2)), np.ones((4, 2))
    upper[0, 1] = 0.4
    np.testing.assert_allclose(coverage(true, lower, upper), [1.0, 0.75])


class BlobSimulator:
    def __init__(self, cut, camera=None):
        self.rendered = 0

    def __call__(self, unit, misplaced=None):
        self.rendered += len(unit)
        return blob_frames(unit)


@pytest.fixture(params=["scores", "small"])
def study(tmp_path, small_gown, monkeypatch, request):
    monkeypatch.setattr(study_module, "Simulator", BlobSimulator)
    split = np.array(["train", "train", "train", "val", "test"])
    data = Loaded(kind="uniform", gowns=[small_gown] * 60, examples=blobs(60, parameters=6), split=np.resize(split, 60))
    other = Loaded(kind="heldout_gown", gowns=[small_gown] * 8, examples=blobs(8, 6, seed=5), split=np.full(8, "test"))
    plan = Plan(steps=3, backbone=request.param, folder=tmp_path, say=lambda _: None)
    return Study(data=data, tests={other.kind: other}, plan=plan, seeds=(0, 1), simulate=11, calibrate=10)


def test_a_study_compares_every_method_on_every_test(study):
    study.run(lambda _: None)
    results = json.loads(write_results(study).read_text())
    rows = {(row["test"], row["method"], row["seed"]): row for row in results["rows"]}
    for test in ("uniform", "heldout_gown"):
        assert {method for t, method, _ in rows if t == test} == set(TITLES) - {"class_centre"}  # there are no classes
        assert {seed for t, method, seed in rows if (t, method) == (test, "paper")} == {0, 1}
    assert rows["uniform", "gp_inversion_simulated", 0]["clips"] == 11
    assert rows["uniform", "paper", 1]["clips"] == 12
    assert set(rows["uniform", "gp_inversion", 0]["coverage"]) == set(NAMES)
    assert results["data"]["hash"] == study.data.examples.hash
    text = table(results)
    assert all(title in text for method, title in TITLES.items() if method != "class_centre")
    assert f"backbone `{study.plan.backbone}`, 3 steps" in text


def test_the_centre_of_the_class_is_shown_for_comparison(study):
    clips = replace(study.data.examples, class_id=np.arange(60) // 5)  # four of five learned from, one of them tested
    replace(study, data=replace(study.data, examples=clips)).run(lambda _: None, ("class_centre",))
    kept = np.load(study.folder / "predictions" / "uniform-class_centre-0.npz")
    np.testing.assert_allclose(kept["unit"], clips.unit.reshape(12, 5, 6)[:, :3].mean(axis=1))
    assert not list(study.folder.glob("predictions/heldout*"))


def test_an_interrupted_study_keeps_what_is_finished(study, monkeypatch):
    study.run(lambda _: None, ("gp_inversion", "random"))
    kept = {p.name: p.stat().st_mtime_ns for p in (study.folder / "predictions").glob("*-piece-*")}
    assert len(kept) == 4  # of 10 for the calibration, 10 and 1, and 8

    def again(*_, **__):
        raise AssertionError("nothing is to be fitted again")

    monkeypatch.setattr(study_module, "fit_gp_inversion", again)
    monkeypatch.setattr(BlobSimulator, "__call__", again)
    study.run(lambda _: None, ("gp_inversion",))
    assert kept == {p.name: p.stat().st_mtime_ns for p in (study.folder / "predictions").glob("*-piece-*")}


def test_other_cuts_are_learned_from_and_tested_apart(study, small_gown):
    falls = np.resize(["train", "train", "train", "val", "test"], 100)
    longer = replace(small_gown, length=small_gown.length + 1)
    some = replace(blobs(200, 6, seed=8), rough=np.arange(200) % 2 == 1)
    cuts = Loaded(kind="cuts", gowns=[longer] * 200, examples=some, split=np.repeat(falls, 2))
    wider = replace(study, cuts=cuts, seeds=(0,))
    wider.run(lambda _: None, ("gp_inversion", "supervised"))
    rows = {(row["test"], row["method"]): row for row in json.loads(write_results(wider).read_text())["rows"]}
    assert {test for test, _ in rows} == {"uniform", "cuts", "cuts_rough", "heldout_gown"}
    assert rows["cuts", "gp_inversion"]["clips"] == rows["cuts_rough", "supervised"]["clips"] == 20
    assert rows["cuts", "gp_inversion_simulated"]["clips"] == 11
    _, record = load_weights(wider.folder / "gp_inversion.safetensors")
    assert record["clips"] == 36 + 120
    assert record["processor_seconds"] > 0
    assert set(load_weights(wider.folder / "gp_inversion.safetensors")[0].inversions) == {
        "clean",
        "clean_other",
        "rough_other",
    }


def test_predictions_from_other_data_are_forgotten(study):
    study.run(lambda _: None, ("random",))
    kept = study.folder / "predictions" / "uniform-random-0.npz"
    before = np.load(kept)["true"]
    study.run(lambda _: None, ("manual",))
    assert kept.exists()
    grown = replace(study, data=replace(study.data, examples=replace(blobs(60, 6, seed=3), hash="other")))
    grown.run(lambda _: None, ("manual",))
    assert not kept.exists()
    assert len(before) == 12


def test_an_interrupted_calibration_keeps_the_fit(study, monkeypatch):
    def killed(*_, **__):
        raise KeyboardInterrupt

    with monkeypatch.context() as before:
        before.setattr(BlobSimulator, "__call__", killed)
        with pytest.raises(KeyboardInterrupt):
            study.run(lambda _: None, ("gp_inversion",))
    monkeypatch.setattr(study_module, "fit_gp_inversion", killed)
    _, fit = load_weights(study.folder / "gp_inversion.safetensors")
    study.run(lambda _: None, ("gp_inversion",))
    _, whole = load_weights(study.folder / "gp_inversion.safetensors")
    assert whole["processor_seconds"] >= fit["processor_seconds"] > 0
    assert (study.folder / "predictions" / "uniform-ours_simulated-0.npz").exists()


def test_box_plot_shows_each_test_of_several_studies(study, tmp_path):
    study.run(lambda _: None, ("random",))
    path = write_results(study)
    second = tmp_path / "second"
    shutil.copytree(study.folder / "predictions", second / "predictions")
    (second / "results.json").write_text(path.read_text().replace('"kind": "uniform"', '"kind": "mixed"'))
    one, two = (imread(box_plot(some, tmp_path / "errors.png")) for some in ([study.folder], [study.folder, second]))
    assert two.size > 1.8 * one.size
    with pytest.raises(CaretreeError, match="there is no study"):
        box_plot([tmp_path / "none"], tmp_path / "errors.png")


def test_box_plot_keeps_backbones_apart(study, tmp_path, monkeypatch):
    study.run(lambda _: None, ("random",))
    path = write_results(study)
    second = tmp_path / "second"
    shutil.copytree(study.folder / "predictions", second / "predictions")
    boxes = []
    monkeypatch.setattr("matplotlib.axes.Axes.boxplot", lambda _, values, **__: boxes.append(len(values)))
    written = json.loads(path.read_text())
    for backbone in ("scores", "densenet121"):
        (second / "results.json").write_text(json.dumps({**written, "backbone": backbone}))
        path.write_text(json.dumps({**written, "backbone": "scores"}))
        box_plot([study.folder, second], tmp_path / "errors.png")
    assert boxes == [1, 1, 2, 2]  # one box where both have the same backbone, for each of two tests


def test_curves_show_every_seed_that_learned(study, tmp_path):
    study.run(lambda _: None, ("paper",))
    write_results(study)
    record = json.loads((study.folder / "seed0" / "contrastive" / "record.json").read_text())
    assert len(record["losses"]) == study.plan.steps  # saved 25 times, or after every step of a short training
    drawn = imread(learning_curves([study.folder], tmp_path / "some.png"))
    shutil.rmtree(study.folder / "seed1")
    fewer = imread(learning_curves([study.folder], tmp_path / "some.png"))
    assert drawn.shape == fewer.shape
    assert (drawn != fewer).any()
