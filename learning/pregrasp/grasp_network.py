"""What fingers take, by the cells around them and where the corner is; trained on the oracle's attempts alone.

A grasp and its mirror image come to the same, with left and right exchanged, so that each attempt counts twice.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch import nn  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch.nn import functional  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ...sim.pregrasp.numbers import PRIMITIVES
from ...sim.pregrasp.surroundings import CELLS

CHANNELS, HIDDEN, DROPPED = 32, 64, 0.3
RATE, DECAY, BATCH = 1e-3, 1e-3, 128
NOISE = 0.006  # of the corner's place while it is trained [m]


class GraspNetwork(nn.Module):
    """Cells (n, up, along, across) and corners (n, 3) [m], to logits of success of each primitive, (n, 3)."""

    def __init__(self) -> None:
        super().__init__()
        self.first = nn.Conv2d(CELLS.up, CHANNELS, 3, 1, 1)
        self.second = nn.Conv2d(CHANNELS, CHANNELS, 3, 2, 1)
        self.third = nn.Linear(CHANNELS * (CELLS.along // 2) * (CELLS.across // 2) + 3, HIDDEN)
        self.fourth, self.heads = nn.Linear(HIDDEN, HIDDEN), nn.Linear(HIDDEN, len(PRIMITIVES))
        self.dropped = nn.Dropout(DROPPED)

    def forward(self, cells: torch.Tensor, corners: torch.Tensor) -> torch.Tensor:
        """Logits (n, 3)."""
        flat = functional.relu(self.second(functional.relu(self.first(cells)))).flatten(1)
        flat = torch.cat([flat, corners / (2 * CELLS.side)], 1)
        flat = self.dropped(functional.relu(self.third(flat)))
        return self.heads(self.dropped(functional.relu(self.fourth(flat))))


class Grasps(NamedTuple):
    """Attempts.

    Attributes:
        cells: (n, up, along, across) float32 as `surroundings` gives them.
        corners: (n, 3) float32 [m].
        primitives: (n,) int.
        won: (n,) bool.
    """

    cells: np.ndarray
    corners: np.ndarray
    primitives: Sequence[int] | np.ndarray
    won: Sequence[bool] | np.ndarray


def together(parts: Sequence[Grasps]) -> Grasps:
    """All of several attempts."""
    return Grasps(*(np.concatenate([np.asarray(part[k]) for part in parts]) for k in range(4)))


def train_grasps(grasps: Grasps, steps: int, seed: int) -> GraspNetwork:
    """A network trained on attempts.

    Args:
        grasps: all of them.
        steps: of the optimiser.
        seed: of weights and choices.
    """
    cells, corners, primitives, won = (np.asarray(part) for part in grasps)
    torch.manual_seed(seed)
    rng = np.random.default_rng([seed, 22])
    network = GraspNetwork()
    optimiser = torch.optim.AdamW(network.parameters(), RATE, weight_decay=DECAY)
    for step in range(steps):
        for group in optimiser.param_groups:
            group["lr"] = RATE * (1.01 - step / steps)
        chosen = rng.integers(len(cells), size=BATCH)
        cell, what = cells[chosen], primitives[chosen].copy()
        corner = corners[chosen] + rng.normal(0.0, NOISE, (BATCH, 3)).astype(np.float32)
        mirrored = rng.random(BATCH) < 0.5
        cell[mirrored], corner[mirrored, 1] = cell[mirrored][..., ::-1], -corner[mirrored, 1]
        what[mirrored] = len(PRIMITIVES) - 1 - what[mirrored]
        logits = network(torch.from_numpy(cell), torch.from_numpy(corner))[torch.arange(BATCH), torch.from_numpy(what)]
        loss = functional.binary_cross_entropy_with_logits(logits, torch.from_numpy(won[chosen]).float())
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    return network.eval()
