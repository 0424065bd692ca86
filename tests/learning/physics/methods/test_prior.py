import numpy as np
from caretree.learning.physics.methods.prior import Prior, fit_prior

from ..moving_blobs import blob_classes, blobs


def test_prior_pulls_towards_the_class_and_weighs_the_evidence():
    prior = Prior(np.array([[0.2, 0.2], [0.8, 0.8]]), np.full(2, 0.01**2))
    mean, deviation = prior.combine(np.array([[0.22, 0.2]]), np.array([[0.01, 0.5]]))
    np.testing.assert_allclose(mean, [[0.21, 0.2]], atol=1e-4)
    np.testing.assert_allclose(deviation, [[0.01 / np.sqrt(2), 0.01]], rtol=1e-2)
    undecided, wide = prior.combine(np.array([[0.5, 0.5]]), np.array([[0.5, 0.5]]))
    np.testing.assert_allclose(undecided, 0.5, atol=1e-6)
    assert (wide > 0.29).all()


def test_without_classes_the_prior_says_nothing():
    examples = blobs(10)
    prior = fit_prior(examples.unit, examples.class_id)
    unit, deviation = np.full((1, 2), 0.3), np.full((1, 2), 0.2)
    mean, same = prior.combine(unit, deviation)
    assert mean is unit
    assert same is deviation


def test_prior_of_classes_knows_their_spread():
    examples = blob_classes(10, 30)
    prior = fit_prior(examples.unit, examples.class_id)
    assert prior.means.shape == (10, 2)
    np.testing.assert_allclose(np.sqrt(prior.variance), 0.005, rtol=0.2)
