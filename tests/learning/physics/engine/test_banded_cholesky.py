import numpy as np
import pytest
import scipy.sparse as sparse
from caretree.learning.physics.engine.fall import cut_of, springs_of
from caretree.sim.spring.banded_cholesky import factor, solve
from caretree.sim.spring.mass_spring import damped, laplacian


@pytest.mark.parametrize("held", [[], [0, 7]])
def test_a_solution_solves_the_system_of_the_free_vertices(small_gown, held):
    springs = springs_of(small_gown, cut_of(small_gown)[1])
    matrix = laplacian(springs, springs.stiffness).toarray() + np.diag(springs.mass)
    free = np.ones(len(matrix), bool)
    free[held] = False
    rng = np.random.default_rng(0)
    right = rng.normal(size=(3, len(matrix)))
    system = factor(sparse.csr_matrix(matrix), free)
    y = np.ascontiguousarray(right[:, system.free])
    solve(system.lower, y)
    np.testing.assert_allclose(matrix[np.ix_(system.free, system.free)] @ y.T, right[:, system.free].T, atol=1e-8)
    assert sorted(system.free) == np.flatnonzero(free).tolist()
    np.testing.assert_array_equal(system.row[system.free], np.arange(free.sum()))
    assert (system.row[held] == -1).all()


def test_the_numbering_keeps_the_band_narrow(small_gown):
    springs = springs_of(small_gown, cut_of(small_gown)[1])
    free = np.ones(len(springs.mass), bool)
    assert damped(springs, free, 0.001).lower.shape[1] < 0.4 * len(free)


def test_every_row_of_a_laplacian_sums_to_zero(small_gown):
    springs = springs_of(small_gown, cut_of(small_gown)[1])
    matrix = laplacian(springs, springs.stiffness).toarray()
    np.testing.assert_allclose(matrix.sum(axis=1), 0.0, atol=1e-9)
    np.testing.assert_allclose(matrix, matrix.T)
    assert np.trace(matrix) == pytest.approx(2 * springs.stiffness.sum())
