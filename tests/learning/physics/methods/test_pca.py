import numpy as np
import pytest
from caretree.learning.physics.methods.pca import fit_compression

from ..moving_blobs import blobs


def test_compression_keeps_what_differs():
    frames = blobs(60).frames
    compression = fit_compression(frames, 10)
    scores = compression(frames)
    assert 2 <= scores.shape[1] <= 10
    np.testing.assert_array_equal(compression.components, compression.components.astype(np.int8))
    length = np.linalg.norm(compression.components, axis=0)
    directions = compression.components / length
    np.testing.assert_allclose(directions.T @ directions, np.eye(scores.shape[1]), atol=2e-2)
    assert (scores**2).sum(axis=1).mean() == pytest.approx(1.0, rel=0.02)
    back = (scores / compression.scale / length) @ directions.T + compression.mean
    flat = frames.reshape(60, -1).astype(float)
    assert ((back - flat) ** 2).sum() < 0.01 * ((flat - flat.mean(axis=0)) ** 2).sum()
