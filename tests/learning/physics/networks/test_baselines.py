import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.networks.baselines import fit_contrastive_regression, fit_residual_only, fit_supervised
from caretree.learning.physics.networks.training import Budget

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
