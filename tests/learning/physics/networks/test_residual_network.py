import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.networks.contrastive_residual import ResidualObjective
from caretree.learning.physics.networks.residual_network import draw_pairs, nearest
from caretree.learning.physics.networks.training import Budget, fit


def test_nearest_finds_the_nearest_and_skips_itself():
    points = torch.tensor([[0.0], [1.0], [1.4], [5.0]])
    assert nearest(points, points)[:, 0].tolist() == [0, 1, 2, 3]
    assert nearest(points, points, skip_self=True)[:, 0].tolist() == [1, 2, 1, 2]


def test_pairs_are_neighbours_in_either_order():
    near = torch.tensor([[1], [0], [3], [2]])
    first, second = draw_pairs(near, np.random.default_rng(0), 200)
    assert ((first ^ 1) == second).all()
    assert 0.3 < (first < second).float().mean() < 0.7


def test_residual_network_learns_a_difference(tmp_path):
    torch.manual_seed(0)
    unit = torch.rand(200, 2)
    embedding = torch.cat([unit, unit.square()], dim=1)
    near = nearest(embedding, embedding, 5, skip_self=True)
    spread = (unit[:, None] - unit[near]).reshape(-1, 2).std(dim=0)
    objective = ResidualObjective(embedding, unit, spread, near)
    record = fit(objective, Budget(steps=150, learning_rate=3e-3), seed=0, folder=tmp_path, about={})
    assert record["losses"][-1] < 0.35
    i, j = draw_pairs(near, np.random.default_rng(5), 100)
    with torch.no_grad():
        left = objective.network(embedding[i], embedding[j]) * spread - (unit[i] - unit[j])
    assert left.square().mean() < 0.3 * (unit[i] - unit[j]).square().mean()
