"""The policy: a small U-net with three heads and a map of the corner, the same for each of the six views."""

from __future__ import annotations

import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch import nn  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch.nn import functional  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ...sim.pregrasp.affordance import CHANNELS
from ...sim.pregrasp.numbers import PRIMITIVES

WIDTHS = (24, 40, 64)  # channels at a half, a quarter and an eighth of the picture's size
MAPS = len(PRIMITIVES) + 1


class PolicyNetwork(nn.Module):
    """What `seen` gives, (n, 5, H, W), to logits of success of each primitive and of the corner, (n, 4, H, W)."""

    def __init__(self) -> None:
        super().__init__()
        a, b, c = WIDTHS
        self.first = nn.Conv2d(CHANNELS, a, 4, 2, 1)
        self.second = nn.Conv2d(a, a, 3, 1, 1)
        self.quarter = nn.Sequential(nn.Conv2d(a, b, 3, 2, 1), nn.ReLU(), nn.Conv2d(b, b, 3, 1, 1), nn.ReLU())
        self.eighth = nn.Sequential(
            nn.Conv2d(b, c, 3, 2, 1),
            nn.ReLU(),
            nn.Conv2d(c, c, 3, 1, 1),
            nn.ReLU(),
        )
        self.whole = nn.Linear(c, c)  # what the picture shows elsewhere
        self.wide = nn.Sequential(nn.Conv2d(c, c, 3, 1, 2, 2), nn.ReLU(), nn.Conv2d(c, c, 3, 1, 1), nn.ReLU())
        self.to_quarter, self.to_half = nn.Conv2d(c, b, 1), nn.Conv2d(b, a, 1)
        self.mix_quarter, self.mix_half = nn.Conv2d(b, b, 3, 1, 1), nn.Conv2d(a, a, 3, 1, 1)
        self.heads = nn.Conv2d(a, 4 * MAPS, 3, 1, 1)
        assert self.heads.bias is not None
        nn.init.constant_(self.heads.bias, -3.0)  # grasps fail, as long as nothing else is known

    def forward(self, image: torch.Tensor) -> torch.Tensor:
        """Logits of a batch of views, (n, 4, H, W): where all is near 0, a sigmoid has no slope to learn by."""
        half = functional.relu(self.second(functional.relu(self.first(image))))
        quarter = self.quarter(half)
        eighth = self.eighth(quarter)
        eighth = self.wide(eighth + self.whole(eighth.mean((2, 3)))[:, :, None, None])
        up = functional.interpolate(self.to_quarter(eighth), scale_factor=2.0, mode="nearest")
        quarter = functional.relu(self.mix_quarter(up + quarter))
        up = functional.interpolate(self.to_half(quarter), scale_factor=2.0, mode="nearest")
        return functional.pixel_shuffle(self.heads(functional.relu(self.mix_half(up + half))), 2)
