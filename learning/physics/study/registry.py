"""Every method by name: how it is fitted, what it is called in tables.

`class_centre` is none: it is told the class, and shown for comparison.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ..methods.method import Examples, Method
from ..networks.baselines import fit_contrastive_regression, fit_residual_only, fit_supervised
from ..networks.contrastive_residual import fit_paper
from ..networks.training import Budget

TITLES = {
    "gp_inversion": "GP inversion",
    "gp_inversion_simulated": "GP inversion, corrected by simulation",
    "paper": "the paper's method",
    "supervised": "baseline 1, supervised",
    "contrastive_regression": "baseline 2, contrastive, then regression",
    "residual_only": "baseline 3, residual without contrastive",
    "manual": "baseline 4, tuned by hand",
    "random": "baseline 5, random",
    "class_centre": "the class told, its centre said",
}
SAVINGS = 25  # checkpoints of a training, and points of its learning curve
NETWORKS = {
    "paper": fit_paper,
    "supervised": fit_supervised,
    "contrastive_regression": fit_contrastive_regression,
    "residual_only": fit_residual_only,
}


@dataclass(frozen=True, kw_only=True)
class Plan:
    """How the networks are fitted.

    Attributes:
        steps: optimiser steps of each phase.
        backbone: of these methods; GP inversion has none.
        folder: of checkpoints; one for each seed.
        say: told of progress.
    """

    steps: int
    backbone: str
    folder: Path
    say: Callable[[str], None]


def fit_network(name: str, train: Examples, plan: Plan, seed: int) -> Method:
    """A fitted method of `NETWORKS`; trainings that the folder holds already are taken up where they ended."""
    budget = Budget(steps=plan.steps, save_every=max(1, plan.steps // SAVINGS))
    return NETWORKS[name](
        train, budget, seed=seed, folder=plan.folder / f"seed{seed}", backbone=plan.backbone, say=plan.say
    )
