import numpy as np
import pytest
from caretree.learning.physics.clips.frames import frames_of


def test_frames_hold_cover_and_depth():
    depth = np.full((1, 2, 4, 4), np.nan, np.float32)
    depth[0, 1, 0, 0] = 2.9
    frames = frames_of(depth)
    assert frames.shape == (1, 2, 2, 2, 2)
    assert frames[0, 1, 0, 0, 0] == 0.25
    assert frames[0, 1, 1, 0, 0] == pytest.approx(0.25, rel=1e-2)  # 0.3 m behind the usual depth, a quarter of a pixel
    assert frames.sum() == pytest.approx(0.5, rel=1e-2)
