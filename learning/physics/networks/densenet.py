"""DenseNet-121 (Huang et al., 2017): every layer of a block sees the outputs of all layers before it.

Written here because no build of torchvision for processors without a graphics card is on the index used, and its
ImageNet weights cannot be had offline: where the paper starts from ImageNet, this one starts from chance.
"""

from __future__ import annotations

import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch import nn  # pyright: ignore[reportMissingImports] - in the extra `learn`

GROWTH = 32
BLOCKS = (6, 12, 24, 16)  # layers per block: with two convolutions each, and 5 more layers, 121


class DenseLayer(nn.Module):
    """Normalise, squeeze to 4 x growth channels, convolve to `growth`, and append to the input."""

    def __init__(self, channels: int, growth: int) -> None:
        super().__init__()
        self.grow = nn.Sequential(
            nn.BatchNorm2d(channels), nn.ReLU(), nn.Conv2d(channels, 4 * growth, 1, bias=False),
            nn.BatchNorm2d(4 * growth), nn.ReLU(), nn.Conv2d(4 * growth, growth, 3, padding=1, bias=False),
        )  # fmt: skip

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        """(B, C, H, W) -> (B, C + growth, H, W)."""
        return torch.cat([x, self.grow(x)], dim=1)


def densenet(*, channels: int, features: int, growth: int, blocks: tuple[int, ...]) -> nn.Sequential:
    """A densely connected network: (B, channels, H, W) -> (B, features), H and W at least 32."""
    width = 2 * growth
    layers: list[nn.Module] = [
        nn.Conv2d(channels, width, 7, stride=2, padding=3, bias=False),
        nn.BatchNorm2d(width), nn.ReLU(), nn.MaxPool2d(3, stride=2, padding=1),
    ]  # fmt: skip
    for number, count in enumerate(blocks):
        for _ in range(count):
            layers.append(DenseLayer(width, growth))
            width += growth
        if number < len(blocks) - 1:  # halve the channels and the image between blocks
            layers += [nn.BatchNorm2d(width), nn.ReLU(), nn.Conv2d(width, width // 2, 1, bias=False), nn.AvgPool2d(2)]
            width //= 2
    layers += [nn.BatchNorm2d(width), nn.ReLU(), nn.AdaptiveAvgPool2d(1), nn.Flatten(), nn.Linear(width, features)]
    return nn.Sequential(*layers)


def densenet121(*, channels: int, features: int) -> nn.Sequential:
    """DenseNet-121 with `features` outputs."""
    return densenet(channels=channels, features=features, growth=GROWTH, blocks=BLOCKS)
