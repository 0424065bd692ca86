import numpy as np
import pytest
from caretree.learning.physics.methods.discrepancy import follow
from caretree.learning.physics.methods.gp_inversion import fit_gp_inversion

from ..moving_blobs import blob_frames, blobs


def scores_of(unit):
    """Six smooth scores of three unknowns, which mix and bend them."""
    mixed = unit @ np.array(
        [[1.0, 0.3, -0.2, 0.5, 0.1, 0.4], [0.2, 1.0, 0.4, -0.3, 0.6, 0.1], [-0.3, 0.1, 1.0, 0.2, -0.5, 0.7]]
    )
    return mixed + 0.15 * np.sin(2.5 * mixed)


def blunt(scores):
    """An estimator that shrinks towards the middle and is off by a twentieth and more."""
    back, *_ = np.linalg.lstsq(scores_of(np.eye(3)).T, scores.T, rcond=None)
    return 0.25 + 0.6 * back.T


def test_simulations_of_the_gown_itself_undo_what_is_wrong_with_a_blunt_estimator():
    true = np.random.default_rng(0).uniform(0.15, 0.85, (10, 3))
    seen = scores_of(true)
    found, misfit = follow(scores_of, blunt, np.full(3, 1.5), seen, 15)
    assert np.median(np.abs(blunt(seen) - true)) > 0.05
    assert np.median(np.abs(found - true)) < 2e-3
    np.testing.assert_allclose(misfit, np.linalg.norm(scores_of(found) - seen, axis=1))


def test_what_is_kept_is_the_nearest_of_all_simulated_and_inside_the_range():
    made = []

    def simulated(unknowns):
        made.append(unknowns)
        return np.random.default_rng(len(made)).random((2, 4))

    seen = np.zeros((2, 4))
    found, misfit = follow(simulated, lambda scores: scores[:, :2] * 3.0 - 1.0, np.ones(2), seen, 12)
    every = np.array([np.linalg.norm(np.random.default_rng(k + 1).random((2, 4)), axis=1) for k in range(12)])
    np.testing.assert_allclose(misfit, every.min(axis=0))
    np.testing.assert_array_equal(found, np.array(made)[every.argmin(axis=0), [0, 1]])
    assert len(made) == 12
    assert np.min(made) >= 0.0
    assert np.max(made) <= 1.0


@pytest.mark.parametrize("clips", [1, 3])
def test_gowns_of_other_cuts_are_simulated_until_their_own_deviation_is_known(clips):
    train, valid, test = blobs(60), blobs(40, seed=1), blobs(clips, seed=2)

    def other_cut(unit):  # the same knobs move other gowns a little differently
        return blob_frames(np.clip(0.1 + 0.75 * np.asarray(unit) + 0.05 * np.asarray(unit)[:, ::-1], 0.0, 1.0))

    method = fit_gp_inversion(train, valid, (train, valid), seed=0, shown=(0, 1))
    frames = other_cut(test.unit)
    sort = method.sort(False, other=True)
    alone, _ = sort.alone(frames)
    found, _ = sort.simulated(frames, other_cut, blunt=True)
    assert np.abs(found - test.unit).max() < 0.1 * np.abs(alone - test.unit).max()
