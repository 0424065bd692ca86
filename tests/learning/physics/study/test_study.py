from dataclasses import replace

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.methods.weights import load_weights
from caretree.learning.physics.study import study as study_module

from ..moving_blobs import BlobSimulator, blobs


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
    assert (study.folder / "predictions" / "uniform-gp_inversion_simulated-0.npz").exists()
