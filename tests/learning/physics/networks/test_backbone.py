import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.networks import backbone
from caretree.learning.physics.networks.backbone import ClipEmbedding, embed
from caretree.learning.physics.networks.densenet import densenet
from caretree.sim.errors import CaretreeError


@pytest.mark.parametrize("size", [16, 32])
def test_small_backbone_embeds_clips(size):
    torch.manual_seed(0)
    network = ClipEmbedding(size=size, embedding=7, features=12)
    assert network(torch.zeros(3, 4, 2, size, size)).shape == (3, 7)


def test_order_of_frames_matters():
    torch.manual_seed(0)
    network = ClipEmbedding(size=16, embedding=4, features=8)
    frames = torch.rand(2, 5, 2, 16, 16)
    assert not torch.allclose(network(frames), network(frames.flip(1)), atol=1e-4)


def test_embedding_in_pieces_is_embedding_at_once():
    torch.manual_seed(0)
    network = ClipEmbedding(size=16, embedding=4, features=8)
    frames = torch.rand(5, 3, 2, 16, 16)
    torch.testing.assert_close(embed(network, frames, batch=2), network(frames).detach())


@pytest.mark.parametrize("half", [False, True])
def test_densenet_learns_in_half_precision_and_embeds_in_full(monkeypatch, half):
    kinds = []
    monkeypatch.setattr(backbone, "has_half", lambda: half)
    monkeypatch.setattr(
        "caretree.learning.physics.networks.densenet.densenet121",
        lambda **sizes: densenet(**sizes, growth=4, blocks=(1, 1)),
    )
    network = ClipEmbedding("densenet121", embedding=4, features=8)
    network.frame_net.register_forward_hook(lambda _, __, out: kinds.append(out.dtype))
    seen = network(torch.rand(2, 3, 2, 32, 32))
    assert seen.shape == (2, 4)
    seen.sum().backward()
    assert all(p.grad.dtype == torch.float32 for p in network.parameters())
    embed(network, torch.rand(2, 3, 2, 32, 32))
    assert kinds == [torch.bfloat16 if half else torch.float32, torch.float32]


def test_scores_are_embedded_without_frames():
    torch.manual_seed(0)
    network = ClipEmbedding("scores", size=9, embedding=4)
    assert network(torch.rand(5, 9)).shape == (5, 4)


def test_unknown_backbone_lists_the_known():
    with pytest.raises(CaretreeError, match=r"resnet.*scores, small, densenet121"):
        ClipEmbedding("resnet")
