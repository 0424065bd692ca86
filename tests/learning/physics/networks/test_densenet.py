import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.networks.densenet import densenet, densenet121


def test_densenet121_has_121_layers():
    layers = [
        m for m in densenet121(channels=2, features=10).modules() if isinstance(m, torch.nn.Conv2d | torch.nn.Linear)
    ]
    assert len(layers) == 121


def test_densenet_layers_see_all_before_them():
    torch.manual_seed(0)
    network = densenet(channels=2, features=3, growth=4, blocks=(2, 2))
    assert network(torch.rand(2, 2, 32, 32)).shape == (2, 3)
    inputs = [m.grow[0].num_features for m in network if hasattr(m, "grow")]
    assert inputs == [8, 12, 8, 12]
