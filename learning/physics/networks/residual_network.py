"""Phase two of the paper: the difference of two clips' parameters from their two embeddings.

    f_p(f_e(x_i), f_e(x_r)) = theta_i - theta_r

The pairs it learns from are those it will meet: a clip and one of its nearest neighbours in the embedding.
"""

from __future__ import annotations

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch import nn  # pyright: ignore[reportMissingImports] - in the extra `learn`

from .backbone import head

NEAREST = 10  # neighbours of each clip from which its partner is drawn


class ResidualNet(nn.Module):
    """f_p: two embeddings, one after the other, -> difference of parameters in units of their spread."""

    def __init__(self, embedding: int, parameters: int) -> None:
        super().__init__()
        self.net = head(2 * embedding, parameters)

    def forward(self, first: torch.Tensor, second: torch.Tensor) -> torch.Tensor:
        """(B, E), (B, E) -> (B, parameters): first minus second."""
        return self.net(torch.cat([first, second], dim=1))


def nearest(queries: torch.Tensor, database: torch.Tensor, count: int = 1, *, skip_self: bool = False) -> torch.Tensor:
    """Indices (Q, count) of the nearest rows of the database; with `skip_self` row i is no neighbour of query i."""
    found = []
    for start in range(0, len(queries), 512):
        distance = torch.cdist(queries[start : start + 512], database)
        if skip_self:
            rows = torch.arange(len(distance))
            distance[rows, rows + start] = torch.inf
        found.append(torch.topk(distance, min(count, len(database) - int(skip_self)), largest=False).indices)
    return torch.cat(found)


def draw_pairs(near: torch.Tensor, rng: np.random.Generator, batch: int) -> tuple[torch.Tensor, torch.Tensor]:
    """Indices (B,) of clips and (B,) of one neighbour each, in random order of the two."""
    first = rng.integers(len(near), size=batch)
    second = near.numpy()[first, rng.integers(near.shape[1], size=batch)]
    swap = rng.random(batch) < 0.5
    return torch.from_numpy(np.where(swap, second, first)), torch.from_numpy(np.where(swap, first, second))
