"""Phase one of the paper: clips of like physics near each other, all others at least a margin apart.

    L(Y, X1, X2) = (1 - Y) D^2 / 2 + Y max(0, m - D)^2 / 2,      D = |f_e(X1) - f_e(X2)|,   m = 1,

with Y = 0 for a positive pair (same class) and Y = 1 for a negative one.  Pairs are mined in each batch: all
positive pairs, and as many negative ones, those that lie nearest in the embedding, because far ones have no gradient.

Data without classes (the uniform set) has no same class.  There, an anchor and its nearest neighbours in parameter
space take the place of a class.
"""

from __future__ import annotations

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`

MARGIN = 1.0
CLASSES_PER_BATCH = 16
CLIPS_PER_CLASS = 4


def contrastive_loss(distance: torch.Tensor, negative: torch.Tensor, margin: float = MARGIN) -> torch.Tensor:
    """The paper's loss of each pair.

    Args:
        distance: (P,) Euclidean distances in the embedding.
        negative: (P,) bool, the paper's Y.
        margin: the paper's m.

    Returns:
        (P,) losses.
    """
    apart = torch.clamp(margin - distance, min=0.0)
    return torch.where(negative, 0.5 * apart**2, 0.5 * distance**2)


def pair_distances(embedding: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
    """Every unordered pair of a batch: first index (P,), second index (P,), distance (P,)."""
    i, j = torch.triu_indices(len(embedding), len(embedding), offset=1)
    # the small number keeps the gradient of the root finite where two embeddings coincide
    return i, j, torch.sqrt(((embedding[i] - embedding[j]) ** 2).sum(dim=1) + 1e-12)


def mined_loss(embedding: torch.Tensor, group: torch.Tensor, margin: float = MARGIN) -> torch.Tensor:
    """Mean loss over all positive pairs of a batch and equally many of its nearest negative pairs.

    Args:
        embedding: (B, E).
        group: (B,) int, equal for clips of like physics.
        margin: the paper's m.
    """
    i, j, distance = pair_distances(embedding)
    negative = group[i] != group[j]
    positive_loss = contrastive_loss(distance[~negative], negative[~negative], margin)
    far = distance[negative]
    hard = torch.topk(far, min(len(far), max(1, len(positive_loss))), largest=False).values
    hard_loss = contrastive_loss(hard, torch.ones(len(hard), dtype=torch.bool), margin)
    return torch.cat([positive_loss, hard_loss]).mean()


class Groups:
    """Draws batches of groups of like clips.

    Args:
        unit: (N, 6) parameters in [0, 1].
        class_id: (N,) int class of each clip, or all negative where there are none.
    """

    def __init__(self, unit: np.ndarray, class_id: np.ndarray) -> None:
        self.members: list[np.ndarray] = []
        if (class_id >= 0).all():
            self.members = [np.flatnonzero(class_id == c) for c in np.unique(class_id)]
            self.members = [m for m in self.members if len(m) > 1]
        else:
            from scipy.spatial import KDTree

            near = KDTree(unit).query(unit, k=min(CLIPS_PER_CLASS, len(unit)))[1]
            self.members = list(np.asarray(near))

    def draw(self, rng: np.random.Generator, classes: int = CLASSES_PER_BATCH) -> tuple[np.ndarray, np.ndarray]:
        """Indices of clips (B,) and the group each stands for (B,)."""
        chosen = rng.choice(len(self.members), size=min(classes, len(self.members)), replace=False)
        members = [self.members[c] for c in chosen]
        clips = [rng.choice(m, size=min(CLIPS_PER_CLASS, len(m)), replace=False) for m in members]
        return np.concatenate(clips), np.repeat(np.arange(len(chosen)), [len(c) for c in clips])
