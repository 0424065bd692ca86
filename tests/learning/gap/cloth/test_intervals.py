import numpy as np
from caretree.learning.gap.cloth.intervals import half_widths
from scipy.signal import lfilter

T, MARKERS = 60, 12


def test_markers_with_memories_and_noise_of_their_own_are_allowed_for():
    rng, held, too_sure, draws = np.random.default_rng(1), np.zeros(2), np.zeros(2), 200
    rise = np.linspace(0.0, 1.0, T)[:, None]
    columns = [np.stack([rise * rng.normal(size=(1, MARKERS)), np.ones((T, MARKERS))], axis=2) for _ in range(2)]
    X = np.concatenate([c.reshape(-1, 2) for c in columns])
    for _ in range(draws):
        loud = rng.uniform(0.3, 2.0, MARKERS)
        noise = [loud * lfilter([0.3], [1.0, -0.95], rng.normal(size=(T + 100, MARKERS)), axis=0)[100:] for _ in "ab"]
        y = np.concatenate([n.ravel() for n in noise])
        theta = np.linalg.lstsq(X, y, rcond=None)[0]
        left = [n - c @ theta for n, c in zip(noise, columns, strict=True)]
        held += np.abs(theta) <= half_widths(columns, left)
        white = np.sqrt(np.diag(np.linalg.inv(X.T @ X)) * np.var(y - X @ theta))
        too_sure += np.abs(theta) <= 1.96 * white
    assert (held / draws > 0.9).all()
    assert (held / draws < 0.99).all()
    assert (too_sure / draws < 0.6).all()


def test_a_number_that_rests_on_few_markers_is_less_sure_and_on_one_nothing_is_known():
    rng = np.random.default_rng(2)
    columns, left = np.zeros((T, MARKERS, 1)), rng.normal(size=(T, MARKERS))
    columns[:, 0] = 1.0
    alone = half_widths([columns], [left])[0]
    columns[:, 1:3] = 1.0
    few = half_widths([columns], [left])[0]
    columns[:] = 1.0
    many = half_widths([columns], [left])[0]
    assert np.isinf(alone)
    assert few > 1.5 * many
