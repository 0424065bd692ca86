"""Gaussian process regression: scores of a clip -> parameters, exact, with one length for all scores.

    k(s, s') = v exp(-|s - s'|^2 / 2 l^2),      mean(s) = k(s, S) (k(S, S) + n I)^-1 y

Length l and noise n of each parameter maximise the likelihood of a part of the training clips; the scale v follows in
closed form.  A parameter that the clip does not show gets a large n and is answered by its mean.
"""

from __future__ import annotations

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch import nn  # pyright: ignore[reportMissingImports] - in the extra `learn`

SUBSET = 800  # clips that choose length and noise: the cost grows with the cube
LENGTHS = np.geomspace(0.3, 8.0, 8)
NOISES = np.geomspace(1e-6, 1.0, 10)


class GaussianProcess(nn.Module):
    """Posterior mean.

    Args:
        inputs: (N, K) scores of the training clips.
        weights: (N, P) (k + n I)^-1 y, times the spread of each parameter.
        lengths: (P,) l.
        centre: (P,) means of the parameters.
    """

    inputs: torch.Tensor
    weights: torch.Tensor
    lengths: torch.Tensor
    centre: torch.Tensor

    def __init__(self, inputs: torch.Tensor, weights: torch.Tensor, lengths: torch.Tensor,
                 centre: torch.Tensor) -> None:  # fmt: skip
        super().__init__()
        self.register_buffer("inputs", inputs)
        self.register_buffer("weights", weights)
        self.register_buffer("lengths", lengths)
        self.register_buffer("centre", centre)

    @torch.no_grad()
    def forward(self, scores: torch.Tensor) -> torch.Tensor:
        """(N, K) -> (N, P)."""
        squares = torch.cdist(scores, self.inputs) ** 2
        columns = [
            torch.exp(-0.5 * squares / self.lengths[p] ** 2).double() @ self.weights[:, p].double()
            for p in range(self.weights.shape[1])
        ]
        return self.centre + torch.stack(columns, dim=1).to(self.centre.dtype)


def fit_gaussian_process(inputs: torch.Tensor, unit: torch.Tensor, seed: int) -> GaussianProcess:
    """Process from training scores (N, K) and parameters (N, P)."""
    rng = np.random.default_rng(seed)
    some = torch.from_numpy(rng.permutation(len(inputs))[:SUBSET])
    centre, spread = unit.mean(dim=0), unit.std(dim=0) + 1e-9
    wanted = ((unit - centre) / spread).double()
    chosen = choose(torch.cdist(inputs[some].double(), inputs[some].double()) ** 2, wanted[some])
    squares = torch.cdist(inputs.double(), inputs.double()) ** 2
    weights = []
    for p, (length, noise) in enumerate(chosen):
        kernel = torch.exp(-0.5 * squares / length**2)
        kernel.diagonal().add_(noise)
        weights.append(torch.cholesky_solve(wanted[:, p : p + 1], torch.linalg.cholesky(kernel))[:, 0] * spread[p])
    lengths = torch.tensor([length for length, _ in chosen])
    return GaussianProcess(inputs, torch.stack(weights, dim=1), lengths, centre)


def choose(squares: torch.Tensor, wanted: torch.Tensor) -> list[tuple[float, float]]:
    """Length and noise (relative to v) of each parameter with the highest likelihood on a grid.

    Args:
        squares: (N, N) squared distances.
        wanted: (N, P) targets with mean zero.
    """
    best = [(np.inf, 1.0, 1.0)] * wanted.shape[1]
    for length in LENGTHS:
        # one eigendecomposition serves every noise and parameter
        values, vectors = torch.linalg.eigh(torch.exp(-0.5 * squares / length**2))
        turned = (vectors.T @ wanted) ** 2
        for noise in NOISES:
            total = values.clamp(min=0.0)[:, None] + noise
            scale = (turned / total).mean(dim=0)  # v, in closed form
            loss = 0.5 * len(squares) * torch.log(scale) + 0.5 * torch.log(total).sum()
            best = [min(b, (float(x), float(length), float(noise))) for b, x in zip(best, loss, strict=True)]
    return [(length, noise) for _, length, noise in best]
