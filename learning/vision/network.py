"""The one network that sees: surface of every pixel, place on the gown's sheet, key points.

A U-net of plain 3 x 3 convolutions.  Its first step halves the picture and its last one gives four pixels at once, so
that no convolution runs at full size.
"""

from __future__ import annotations

import itertools

import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch import nn  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch.nn import functional  # pyright: ignore[reportMissingImports] - in the extra `learn`

from .labels import KEY_POINTS, SURFACES
from .sheet_nodes import SHEET_NODES

WIDTHS = (16, 32, 64, 96, 96)  # channels at a half, a quarter ... of the picture's size
BLOCKS = (1, 1, 2, 4)  # residual ones at a quarter ... : what tells left from right is the whole picture
NOWHERE = -9.0  # first score of a key point's being in a cell: together they are as likely as its not being there
OUTPUTS = ("surface", "sheet", "heat", "offset")


class Residual(nn.Module):
    """Two convolutions around which the input goes on."""

    def __init__(self, width: int) -> None:
        super().__init__()
        self.first = nn.Conv2d(width, width, 3, padding=1)
        self.second = nn.Conv2d(width, width, 3, padding=1)
        nn.init.zeros_(self.second.weight)  # nothing at first: deep nets train from the start

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        """(n, width, h, w) to the same."""
        return functional.relu(x + self.second(functional.relu(self.first(x))))


class SeeingNetwork(nn.Module):
    """What `dataset.seen` gives, (n, 8, 192, 256), to four maps.

    Returns `surface` (n, 7, 192, 256) scores of `SURFACES`; at every fourth pixel `sheet` (n, S, 48, 64) scores of
    `SHEET_NODES`, one axis after the other, `heat` (n, K, 48, 64) scores of a key point's being here, beside 0 for its
    being nowhere in the picture, and `offset` (n, K, 48, 64) how much deeper it is than what the pixel shows [m].
    """

    def __init__(self) -> None:
        super().__init__()
        self.stem = nn.Conv2d(9, WIDTHS[0], 4, 2, 1)
        self.down = nn.ModuleList(
            nn.Sequential(nn.Conv2d(a, b, 3, 2, 1), nn.ReLU(), *(Residual(b) for _ in range(blocks)))
            for (a, b), blocks in zip(itertools.pairwise(WIDTHS), BLOCKS, strict=True)
        )
        self.up = nn.ModuleList(nn.Conv2d(b, a, 1) for a, b in itertools.pairwise(WIDTHS))
        self.mix = nn.ModuleList(nn.Conv2d(a, a, 3, padding=1) for a in WIDTHS[:-1])
        self.surface = nn.Conv2d(WIDTHS[0], 4 * len(SURFACES), 3, padding=1)
        self.place = nn.Conv2d(WIDTHS[1], WIDTHS[2], 3, padding=1)
        self.context = nn.Conv2d(WIDTHS[2], WIDTHS[2], 3, padding=1)  # more than fits through a quarter's channels
        self.nodes = nn.Conv2d(WIDTHS[2], sum(len(axis) for axis in SHEET_NODES), 1)
        self.peaks = nn.Conv2d(WIDTHS[2], 2 * len(KEY_POINTS), 1)
        for name, layer in self.named_modules():
            if isinstance(layer, nn.Conv2d) and not name.endswith("second"):  # torch's own scale fades layer by layer
                nn.init.kaiming_normal_(layer.weight, nonlinearity="relu")
                assert layer.bias is not None
                nn.init.zeros_(layer.bias)
        for head in (self.surface, self.nodes, self.peaks):
            nn.init.normal_(head.weight, std=0.02)
        assert self.peaks.bias is not None
        nn.init.constant_(self.peaks.bias[: len(KEY_POINTS)], NOWHERE)

    def forward(self, image: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor, torch.Tensor]:
        """See a batch of pictures."""
        colour = image[:, :3] / 128.0 - 1.0
        depth, level = image[:, 3:4], image[:, 4:5]
        there = torch.clamp(depth * 10.0, 0.0, 1.0)  # 0 where there is no depth
        near = there / torch.clamp(depth, min=0.25) - 1.0
        x = torch.cat([colour, near, there * (level - 0.7), there, image[:, 5:]], 1)
        x = functional.relu(self.stem(x))
        kept = [x]
        for step in self.down:
            x = step(x)
            kept.append(x)
        quarter = eighth = x
        for k in range(len(self.up) - 1, -1, -1):
            wider = functional.interpolate(self.up[k](x), scale_factor=2.0, mode="bilinear", align_corners=False)
            x = functional.relu(self.mix[k](wider + kept[k]))
            if k == 2:
                eighth = x
            if k == 1:
                quarter = x
        context = functional.interpolate(self.context(eighth), scale_factor=2.0, mode="bilinear", align_corners=False)
        place = functional.relu(self.place(quarter) + context)
        heat, offset = self.peaks(place).chunk(2, 1)
        return functional.pixel_shuffle(self.surface(x), 2), self.nodes(place), heat, offset
