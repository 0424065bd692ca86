import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.networks.contrastive_residual import fit_paper
from caretree.learning.physics.networks.training import Budget

from ..moving_blobs import as_tensors, blob_classes


def test_papers_method_recognises_classes(tmp_path):
    train, test = as_tensors(blob_classes(6, 12)), as_tensors(blob_classes(6, 4, seed=1))
    method = fit_paper(train, Budget(steps=60, learning_rate=3e-3), seed=0, folder=tmp_path, backbone="small",
                       say=lambda _: None)  # fmt: skip
    errors = np.abs(method.estimate(test.frames) - test.unit)
    assert np.median(errors) < 0.02  # a wrong class is off by 0.1 and more
