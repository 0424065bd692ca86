"""The paper's baselines 1 to 3: the same backbone, data and steps, with one idea of the method taken away each time.

Baselines 4 and 5 need no training: see trivial_baselines.py.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch import nn  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ..methods.method import Examples, Method
from .backbone import ClipEmbedding, embed, head
from .contrastive_residual import HEAD_BATCH, NearestPlusResidual, fit_embedding
from .residual_network import ResidualNet
from .training import Budget, Objective, Say, fit

BATCH = 64  # clips a step, as in phase one of the method


class Regressor(nn.Module, Method):
    """An embedding and a head that says the parameters.

    Args:
        name: `supervised` (baseline 1) or `contrastive_regression` (baseline 2).
        embedding: f_e.
        regression: head.
        centre: (6,) what is added to the head's outputs...
        spread: (6,) ... after multiplying by this.
    """

    centre: torch.Tensor
    spread: torch.Tensor

    def __init__(self, name: str, embedding: ClipEmbedding, regression: nn.Module, *, centre: torch.Tensor,
                 spread: torch.Tensor) -> None:  # fmt: skip
        super().__init__()
        self.name, self.embedding, self.regression = name, embedding, regression
        self.register_buffer("centre", centre)
        self.register_buffer("spread", spread)

    @torch.no_grad()
    def estimate(self, frames: torch.Tensor) -> np.ndarray:
        """Straight from the embedding."""
        self.regression.eval()
        out = self.regression(embed(self.embedding, frames)) * self.spread + self.centre
        return out.clamp(0.0, 1.0).numpy()


class SupervisedObjective(Objective):
    """Baseline 1: embedding and head trained together to say the parameters."""

    def __init__(self, train: Examples, backbone: str, wanted: torch.Tensor) -> None:
        embedding = ClipEmbedding(backbone, size=train.frames.shape[-1])
        self.network = nn.Sequential(embedding, nn.ReLU(), head(embedding.embedding, wanted.shape[1]))
        self.frames, self.wanted = train.frames, wanted

    def loss(self, rng: np.random.Generator) -> torch.Tensor:
        """Mean square error of one batch, in units of the parameters' spread."""
        i = torch.from_numpy(rng.integers(len(self.frames), size=BATCH))
        return ((self.network(self.frames[i].float()) - self.wanted[i]) ** 2).mean()


class EmbeddingHeadObjective(Objective):
    """Second phase of baseline 2: a head on the fixed contrastive embedding."""

    def __init__(self, embedding: torch.Tensor, wanted: torch.Tensor) -> None:
        self.network = head(embedding.shape[1], wanted.shape[1])
        self.embedding, self.wanted = embedding, wanted

    def loss(self, rng: np.random.Generator) -> torch.Tensor:
        """Mean square error of one batch."""
        i = torch.from_numpy(rng.integers(len(self.embedding), size=HEAD_BATCH))
        return ((self.network(self.embedding[i]) - self.wanted[i]) ** 2).mean()


class SiameseResidualObjective(Objective):
    """Baseline 3: embedding and residual network trained together on any two clips, in one phase."""

    def __init__(self, train: Examples, backbone: str, unit: torch.Tensor, spread: torch.Tensor) -> None:
        self.embedding = ClipEmbedding(backbone, size=train.frames.shape[-1])
        self.residual = ResidualNet(self.embedding.embedding, unit.shape[1])
        self.network = nn.ModuleList([self.embedding, self.residual])
        self.frames, self.unit, self.spread = train.frames, unit, spread

    def loss(self, rng: np.random.Generator) -> torch.Tensor:
        """Mean square error of the difference; half a batch of pairs is as many clips as the others see a step."""
        i = torch.from_numpy(rng.integers(len(self.frames), size=BATCH))
        first, second = self.embedding(self.frames[i].float()).chunk(2)
        a, b = i.chunk(2)
        wanted = (self.unit[a] - self.unit[b]) / self.spread
        return ((self.residual(first, second) - wanted) ** 2).mean()


def _scale(train: Examples) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
    """Parameters, their centre and their spread."""
    unit = torch.from_numpy(train.unit).float()
    return unit, unit.mean(dim=0), unit.std(dim=0)


def fit_supervised(train: Examples, budget: Budget, *, seed: int, folder: Path, backbone: str, say: Say) -> Regressor:
    """Baseline 1."""
    unit, centre, spread = _scale(train)
    torch.manual_seed(seed)
    objective = SupervisedObjective(train, backbone, (unit - centre) / spread)
    about = {"method": "supervised", "data": train.hash, "clips": len(train), "backbone": backbone}
    fit(objective, budget, seed=seed, folder=folder / "supervised", about=about, say=say)
    embedding, *rest = objective.network.children()
    assert isinstance(embedding, ClipEmbedding)
    return Regressor("supervised", embedding, nn.Sequential(*rest), centre=centre, spread=spread)


def fit_contrastive_regression(
    train: Examples, budget: Budget, *, seed: int, folder: Path, backbone: str, say: Say
) -> Regressor:
    """Baseline 2."""
    embedding = fit_embedding(train, budget, seed=seed, folder=folder, backbone=backbone, say=say)
    unit, centre, spread = _scale(train)
    torch.manual_seed(seed)
    objective = EmbeddingHeadObjective(embed(embedding, train.frames), (unit - centre) / spread)
    about = {"method": "contrastive_regression", "data": train.hash, "clips": len(train), "backbone": backbone}
    fit(objective, budget, seed=seed, folder=folder / "contrastive_regression", about=about, say=say)
    return Regressor("contrastive_regression", embedding, objective.network, centre=centre, spread=spread)


def fit_residual_only(
    train: Examples, budget: Budget, *, seed: int, folder: Path, backbone: str, say: Say
) -> NearestPlusResidual:
    """Baseline 3."""
    unit, _, spread = _scale(train)
    torch.manual_seed(seed)
    objective = SiameseResidualObjective(train, backbone, unit, spread)
    about = {"method": "residual_only", "data": train.hash, "clips": len(train), "backbone": backbone}
    fit(objective, budget, seed=seed, folder=folder / "residual_only", about=about, say=say)
    database = embed(objective.embedding, train.frames)
    method = NearestPlusResidual(objective.embedding, objective.residual, database=database, unit=unit, spread=spread)
    method.name = "residual_only"
    return method
