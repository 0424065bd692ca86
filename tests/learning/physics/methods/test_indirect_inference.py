import numpy as np
import pytest
from caretree.learning.physics.methods.indirect_inference import match


@pytest.mark.parametrize("measure", [(), (0, 1, 2)])
def test_matching_undoes_the_bias_of_an_estimator(measure):
    true = np.random.default_rng(0).uniform(0.2, 0.8, (20, 3))

    def answer(unit):  # shrinks towards the middle, bends, and mixes the parameters
        bent = 0.6 * unit + 0.2 + 0.05 * np.sin(4 * unit)
        return bent + 0.1 * bent[:, [1, 2, 0]] - 0.05

    def answers(unit):
        return answer(unit), np.linalg.norm(unit - true, axis=1)

    wanted = answer(true)
    found, misfit = match(answers, wanted, np.full_like(true, 0.05), 8, measure=measure)
    assert np.abs(wanted - true).max() > 0.05
    assert np.median(np.abs(found - true)) < 1e-3
    np.testing.assert_allclose(misfit, np.linalg.norm(found - true, axis=1))


def test_matching_never_returns_worse_than_the_best_it_saw():
    seen = []

    def answers(unit):
        seen.append(np.abs(unit[:, 0] - 0.5))
        return np.random.default_rng(len(seen)).random(unit.shape), seen[-1]

    _, misfit = match(answers, np.full((3, 2), 0.9), np.full((3, 2), 0.1), 5)
    np.testing.assert_allclose(misfit, np.min(seen, axis=0))


def test_matching_ends_when_nothing_is_left_to_do():
    calls = []

    def answers(unit):
        calls.append(unit)
        return unit, np.zeros(len(unit))

    found, _ = match(answers, np.full((2, 3), 0.4), np.full((2, 3), 0.1), 9)
    assert len(calls) == 1
    np.testing.assert_allclose(found, 0.4)
