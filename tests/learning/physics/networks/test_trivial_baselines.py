import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.clips.parameters import BASE, HIGH, LOW, values_to_unit
from caretree.learning.physics.networks.trivial_baselines import ManualTuning, RandomParameters, settings

from ..moving_blobs import blobs


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
