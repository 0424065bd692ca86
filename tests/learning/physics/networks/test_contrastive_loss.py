import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.networks.contrastive_loss import Groups, contrastive_loss, mined_loss, pair_distances


def test_loss_is_the_papers():
    distance = torch.tensor([0.0, 0.6, 0.6, 2.0])
    negative = torch.tensor([False, False, True, True])
    expected = torch.tensor([0.0, 0.5 * 0.36, 0.5 * 0.16, 0.0])
    torch.testing.assert_close(contrastive_loss(distance, negative), expected)


def test_margin_is_where_negatives_stop_pushing():
    distance = torch.tensor([1.5], requires_grad=True)
    contrastive_loss(distance, torch.tensor([True]), margin=2.0).sum().backward()
    assert distance.grad.item() == pytest.approx(-0.5)


def test_every_pair_once():
    i, j, distance = pair_distances(torch.tensor([[0.0], [3.0], [7.0]]))
    assert [(int(a), int(b)) for a, b in zip(i, j, strict=True)] == [(0, 1), (0, 2), (1, 2)]
    torch.testing.assert_close(distance, torch.tensor([3.0, 7.0, 4.0]))


def test_nearest_negatives_are_mined():
    group = torch.tensor([0, 0, 1, 2])
    near = torch.tensor([[0.0], [0.2], [0.5], [9.0]], requires_grad=True)
    # one positive pair at 0.2, so one negative is mined: the nearest, at 0.3
    assert mined_loss(near, group).item() == pytest.approx((0.5 * 0.2**2 + 0.5 * 0.7**2) / 2, rel=1e-4)


def test_coinciding_embeddings_have_a_finite_gradient():
    same = torch.zeros(4, 3, requires_grad=True)
    mined_loss(same, torch.tensor([0, 0, 1, 1])).backward()
    assert torch.isfinite(same.grad).all()


def test_groups_are_classes_where_there_are_classes():
    class_id = np.repeat(np.arange(5), 6)
    clips, group = Groups(np.random.default_rng(0).random((30, 6)), class_id).draw(np.random.default_rng(1), 3)
    assert len(clips) == 12
    for g in range(3):
        assert len(set(class_id[clips[group == g]])) == 1


def test_without_classes_neighbours_are_groups():
    unit = np.repeat(np.linspace(0.0, 1.0, 10), 4)[:, None] + np.tile([0.0, 1e-4, 2e-4, 3e-4], 10)[:, None]
    clips, group = Groups(unit, np.full(40, -1)).draw(np.random.default_rng(1), 4)
    for g in range(4):
        assert np.ptp(unit[clips[group == g]]) < 0.01
