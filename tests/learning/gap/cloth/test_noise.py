import numpy as np
import pytest
from caretree.learning.gap.cloth.noise import bursts, coherence, neighbours
from scipy.signal import lfilter


def test_neighbours_share_a_model_error_and_not_their_noise():
    rng = np.random.default_rng(0)
    points = np.array([(i * 0.1, j * 0.1, 0.0) for i in range(4) for j in range(4)])
    noise = [0.01 * rng.normal(size=(80, 48))]
    alone = coherence(noise, neighbours(points), 16)
    assert alone.p_value > 0.05
    assert alone.floor == pytest.approx(0.01, rel=0.1)
    swing = 0.02 * np.sin(np.linspace(0, 6, 80))[:, None] * np.ones(48)
    both = coherence([noise[0] + swing], neighbours(points), 16)
    assert both.p_value < 1e-6
    assert both.floor == pytest.approx(0.01, rel=0.25)
    assert both.shared == pytest.approx(0.02**2 / 2, rel=0.3)


def test_a_cloth_that_buckles_late_is_loud_then_and_noise_with_a_memory_is_not():
    rng = np.random.default_rng(1)
    white = rng.normal(size=(600, 48))
    slow = lfilter([0.5], [1.0, -0.9], white, axis=0)[-60:]
    assert bursts([slow, white[:60]], 16) > 0.05
    twisted = np.where(np.arange(60)[:, None] > 45, 4.0, 0.0) * np.where(np.arange(48) % 2, 1.0, -1.0)
    assert bursts([slow + twisted], 16) < 1e-6
