"""Principal components of frames: a clip of 30,000 numbers becomes about a hundred."""

from __future__ import annotations

import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch import nn  # pyright: ignore[reportMissingImports] - in the extra `learn`

CHUNK = 512  # clips at a time
CLIPS = 1500  # that choose the directions; more change them little and cost more than all the rest of the fit


class Compression(nn.Module):
    """Linear: scores of a clip along the directions in which the training clips differ most.

    Each score is divided by the root of its spread, half-way between leaving the scores as they are, where the few
    directions of the large motion drown the rest, and giving all the same weight, where pixel noise does.

    Args:
        mean: (D,) of the flattened frames.
        components: (D, K) orthonormal.
        scale: (K,) what each score is multiplied by.
    """

    mean: torch.Tensor
    components: torch.Tensor
    scale: torch.Tensor

    def __init__(self, mean: torch.Tensor, components: torch.Tensor, scale: torch.Tensor) -> None:
        super().__init__()
        self.register_buffer("mean", mean)
        self.register_buffer("components", components)
        self.register_buffer("scale", scale)

    def forward(self, frames: torch.Tensor) -> torch.Tensor:
        """Scores: (N, T, 2, S, S) -> (N, K), whose mean square length is one over the training clips."""
        parts = [
            (frames[i : i + CHUNK].float().flatten(1) - self.mean) @ self.components
            for i in range(0, len(frames), CHUNK)
        ]
        return torch.cat(parts) * self.scale


def fit_compression(frames: torch.Tensor, count: int, seed: int = 0) -> Compression:
    """Compression from training clips.

    Args:
        frames: (N, T, 2, S, S).
        count: scores K; fewer where there are not so many clips.
        seed: of the random projection that finds the directions.
    """
    torch.manual_seed(seed)
    flat = frames[torch.randperm(len(frames))[:CLIPS]].float().flatten(1)
    mean = flat.mean(dim=0)
    flat -= mean
    count = min(count, len(flat) - 1)
    _, values, directions = torch.svd_lowrank(flat, q=min(count + 10, *flat.shape), niter=3)
    spread = values[:count] / len(flat) ** 0.5 + 1e-9
    return Compression(mean, directions[:, :count].contiguous(), 1.0 / (spread * spread.sum()).sqrt())
