import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.clips.parameters import BASE, HIGH, LOW, values_to_unit
from caretree.learning.physics.networks.baselines import fit_contrastive_regression, fit_residual_only, fit_supervised
from caretree.learning.physics.networks.training import Budget
from caretree.learning.physics.networks.trivial_baselines import ManualTuning, RandomParameters, settings

from ..moving_blobs import as_tensors, blobs


@pytest.mark.parametrize("fitter", [fit_supervised, fit_contrastive_regression, fit_residual_only])
def test_each_learns_more_than_the_mean(fitter, tmp_path):
    train, test = as_tensors(blobs(80)), as_tensors(blobs(30, seed=1))
    method = fitter(train, Budget(steps=50, learning_rate=3e-3), seed=0, folder=tmp_path, backbone="small",
                    say=lambda _: None)  # fmt: skip
    estimated = method.estimate(test.frames)
    assert estimated.shape == (30, 2)
    assert estimated.min() >= 0
    assert estimated.max() <= 1
    by_mean = np.abs(test.unit - train.unit.mean(axis=0)).mean()
    assert np.abs(test.unit - estimated).mean() < 0.8 * by_mean


def test_baseline_2_leaves_the_embedding_of_phase_one_alone(tmp_path):
    train = as_tensors(blobs(40))
    arguments = {"seed": 0, "folder": tmp_path, "backbone": "small", "say": lambda _: None}
    method = fit_contrastive_regression(train, Budget(steps=5), **arguments)
    state = torch.load(tmp_path / "contrastive" / "checkpoint.pt", weights_only=True)["network"]
    for key, value in method.embedding.state_dict().items():
        torch.testing.assert_close(value, state[key])


def test_manual_tuning_takes_the_setting_that_looks_most_alike():
    tried = blobs(9)
    estimated = ManualTuning(tried.unit, tried.frames).estimate(tried.frames[[4, 2]])
    np.testing.assert_array_equal(estimated, tried.unit[[4, 2]])


def test_settings_of_a_person_lie_in_range_and_hold_the_usual_gown():
    tried = settings()
    assert tried.shape == (9, 6)
    assert (tried >= LOW).all()
    assert (tried <= HIGH).all()
    assert any(np.allclose(row, BASE) for row in tried)
    assert np.isfinite(values_to_unit(tried)).all()


def test_random_parameters_are_uniform_and_seeded():
    frames = np.zeros((4000, 1))
    drawn = RandomParameters(3).estimate(frames)
    np.testing.assert_array_equal(drawn, RandomParameters(3).estimate(frames))
    np.testing.assert_allclose(drawn.mean(axis=0), 0.5, atol=0.03)
