import numpy as np
from caretree.learning.physics.methods.gaussian_process import fit_gaussian_process


def test_gaussian_process_follows_what_shows_and_averages_what_does_not():
    rng = np.random.default_rng(0)
    inputs = rng.normal(size=(150, 2))
    shown, hidden = np.sin(inputs[:, 0]) + 0.3 * inputs[:, 1], rng.normal(size=150)
    process = fit_gaussian_process(inputs[:120], np.column_stack([shown, hidden])[:120], seed=0)
    answers = process(inputs[120:])
    assert np.median(np.abs(answers[:, 0] - shown[120:])) < 0.02
    assert answers[:, 1].std() < 0.4 * hidden.std()
    np.testing.assert_allclose(process.distance(inputs[:5]), 0.0, atol=1e-6)
