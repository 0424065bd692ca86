import json
import shutil

import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.study.evaluate import write_results
from caretree.learning.physics.study.figures import box_plot, learning_curves
from caretree.sim.errors import CaretreeError
from matplotlib.image import imread


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
