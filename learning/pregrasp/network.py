"""The policy: a small U-net with three heads, the same for each of the six views."""

from __future__ import annotations

import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch import nn  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch.nn import functional  # pyright: ignore[reportMissingImports] - in the extra `learn`

from .affordance import CHANNELS
from .numbers import PRIMITIVES

WIDTHS = (16, 32, 48)  # channels at a half, a quarter and an eighth of the picture's size


class PolicyNetwork(nn.Module):
    """What `seen` gives, (n, 5, H, W), to the expected reward of each primitive at each pixel, (n, 3, H, W)."""

    def __init__(self) -> None:
        super().__init__()
        a, b, c = WIDTHS
        self.first = nn.Conv2d(CHANNELS, a, 4, 2, 1)
        self.quarter = nn.Sequential(nn.Conv2d(a, b, 3, 2, 1), nn.ReLU(), nn.Conv2d(b, b, 3, 1, 1), nn.ReLU())
        self.eighth = nn.Sequential(
            nn.Conv2d(b, c, 3, 2, 1),
            nn.ReLU(),
            nn.Conv2d(c, c, 3, 1, 1),
            nn.ReLU(),
            nn.Conv2d(c, c, 3, 1, 1),
            nn.ReLU(),
        )
        self.to_quarter, self.to_half = nn.Conv2d(c, b, 1), nn.Conv2d(b, a, 1)
        self.mix_quarter, self.mix_half = nn.Conv2d(b, b, 3, 1, 1), nn.Conv2d(a, a, 3, 1, 1)
        self.heads = nn.Conv2d(a, 4 * len(PRIMITIVES), 3, 1, 1)
        assert self.heads.bias is not None
        nn.init.constant_(self.heads.bias, -3.0)  # grasps fail, as long as nothing else is known

    def forward(self, image: torch.Tensor) -> torch.Tensor:
        """Expected rewards of a batch of views, (n, 3, H, W), 0 to 1."""
        return torch.sigmoid(self.logits(image))

    def logits(self, image: torch.Tensor) -> torch.Tensor:
        """Their logits (n, 3, H, W), which a loss needs: where all is near 0, a sigmoid has no slope to learn by."""
        half = functional.relu(self.first(image))
        quarter = self.quarter(half)
        up = functional.interpolate(self.to_quarter(self.eighth(quarter)), scale_factor=2.0, mode="nearest")
        quarter = functional.relu(self.mix_quarter(up + quarter))
        up = functional.interpolate(self.to_half(quarter), scale_factor=2.0, mode="nearest")
        return functional.pixel_shuffle(self.heads(functional.relu(self.mix_half(up + half))), 2)
