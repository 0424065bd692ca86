"""The paper's method: embed, find the nearest known clip, add what the residual network says is missing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch import nn  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ..methods.method import Examples, Method
from .backbone import ClipEmbedding, embed
from .contrastive_loss import Groups, mined_loss
from .residual_network import NEAREST, ResidualNet, draw_pairs, nearest
from .training import Budget, Objective, Say, fit

HEAD_BATCH = 256  # pairs of embeddings a step in phase two


class ContrastiveObjective(Objective):
    """Phase one."""

    def __init__(self, train: Examples, backbone: str) -> None:
        self.embedding = ClipEmbedding(backbone, size=train.frames.shape[-1])
        self.network = self.embedding
        self.frames = train.frames
        self.groups = Groups(train.unit, train.class_id)

    def loss(self, rng: np.random.Generator) -> torch.Tensor:
        """Mined contrastive loss of one batch."""
        clips, group = self.groups.draw(rng)
        return mined_loss(self.network(self.frames[torch.from_numpy(clips)].float()), torch.from_numpy(group))


class ResidualObjective(Objective):
    """Phase two, on fixed embeddings."""

    def __init__(self, embedding: torch.Tensor, unit: torch.Tensor, spread: torch.Tensor, near: torch.Tensor) -> None:
        self.residual = ResidualNet(embedding.shape[1], unit.shape[1])
        self.network = self.residual
        self.embedding, self.unit, self.spread, self.near = embedding, unit, spread, near

    def loss(self, rng: np.random.Generator) -> torch.Tensor:
        """Mean square error of the difference, in units of its spread."""
        i, j = draw_pairs(self.near, rng, HEAD_BATCH)
        wanted = (self.unit[i] - self.unit[j]) / self.spread
        return ((self.network(self.embedding[i], self.embedding[j]) - wanted) ** 2).mean()


class NearestPlusResidual(nn.Module, Method):
    """A fitted embedding, a data base of embedded clips and a residual network.

    Args:
        embedding: f_e.
        residual: f_p.
        database: (N, E) embeddings of the known clips.
        unit: (N, 6) their parameters.
        spread: (6,) what the residual network's outputs are multiplied by.
    """

    name = "paper"
    database: torch.Tensor
    unit: torch.Tensor
    spread: torch.Tensor

    def __init__(self, embedding: ClipEmbedding, residual: ResidualNet, *, database: torch.Tensor,
                 unit: torch.Tensor, spread: torch.Tensor) -> None:  # fmt: skip
        super().__init__()
        self.embedding, self.residual = embedding, residual
        self.register_buffer("database", database)
        self.register_buffer("unit", unit)
        self.register_buffer("spread", spread)

    @torch.no_grad()
    def estimate(self, frames: torch.Tensor) -> np.ndarray:
        """Nearest neighbour plus residual."""
        seen = embed(self.embedding, frames)
        found = nearest(seen, self.database)[:, 0]
        self.residual.eval()
        difference = self.residual(seen, self.database[found]) * self.spread
        return (self.unit[found] + difference).clamp(0.0, 1.0).numpy()


def fit_embedding(
    train: Examples, budget: Budget, *, seed: int, folder: Path, backbone: str, say: Say
) -> ClipEmbedding:
    """Phase one; a finished one in the folder is taken as it is, since baseline 2 shares it."""
    torch.manual_seed(seed)
    objective = ContrastiveObjective(train, backbone)
    about = {"method": "contrastive", "data": train.hash, "clips": len(train), "backbone": backbone}
    fit(objective, budget, seed=seed, folder=folder / "contrastive", about=about, say=say)
    return objective.embedding


def fit_paper(
    train: Examples, budget: Budget, *, seed: int, folder: Path, backbone: str, say: Say
) -> NearestPlusResidual:
    """Both phases of the paper's method."""
    embedding = fit_embedding(train, budget, seed=seed, folder=folder, backbone=backbone, say=say)
    database, unit = embed(embedding, train.frames), torch.from_numpy(train.unit).float()
    near = nearest(database, database, NEAREST, skip_self=True)
    spread = (unit[:, None] - unit[near]).reshape(-1, unit.shape[1]).std(dim=0)
    torch.manual_seed(seed)
    objective = ResidualObjective(database, unit, spread, near)
    about = {"method": "residual", "data": train.hash, "clips": len(train), "backbone": backbone}
    fit(objective, budget, seed=seed, folder=folder / "residual", about=about, say=say)
    return NearestPlusResidual(embedding, objective.residual, database=database, unit=unit, spread=spread)
