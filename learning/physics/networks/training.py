"""One training loop for every method: same optimiser, same number of steps, resumable, and it records what it did.

A batch is drawn from (seed, step) alone, so that a training stopped and resumed gives the weights of one that was not.
"""

from __future__ import annotations

import json
import os
import platform
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch import nn  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ....sim.errors import CaretreeError
from .backbone import has_half

Say = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Budget:
    """How much a training may do.

    Attributes:
        steps: optimiser steps.
        learning_rate: at the start; it falls to zero along half a cosine.
        save_every: steps between checkpoints.
    """

    steps: int = 2500
    learning_rate: float = 1e-3
    save_every: int = 250

    def __post_init__(self) -> None:
        """Reject a budget that does nothing.

        Raises:
            CaretreeError: a number is not positive.
        """
        if min(self.steps, self.learning_rate, self.save_every) <= 0:
            raise CaretreeError(
                f"steps, learning rate and save interval must be positive, not {self.steps}, "
                f"{self.learning_rate} and {self.save_every}"
            )


class Objective(ABC):
    """What is minimised: networks and the loss of one batch.

    Attributes:
        network: all that is trained.
    """

    network: nn.Module

    @abstractmethod
    def loss(self, rng: np.random.Generator) -> torch.Tensor:
        """Loss of one batch drawn with `rng`: a scalar with a gradient."""


def machine() -> dict[str, object]:
    """What the training ran on, without the machine's name."""
    return {
        "processor": platform.machine(), "system": platform.system(), "cores": os.cpu_count(),
        "threads": torch.get_num_threads(), "python": platform.python_version(), "torch": torch.__version__,
        "bfloat16": has_half(),
    }  # fmt: skip


def fit(
    objective: Objective,
    budget: Budget,
    *,
    seed: int,
    folder: Path,
    about: dict[str, object],
    say: Say = lambda _: None,
) -> dict[str, object]:
    """Train, or go on with a training, and leave the weights in `objective.network`.

    Args:
        objective: networks and loss; its networks' first weights must come from `torch.manual_seed(seed)`.
        budget: steps and learning rate.
        seed: of the batches.
        folder: gets checkpoint.pt and, at the end, record.json.
        about: method, data hash and the like, written into the record and compared before resuming.
        say: told of progress.

    Returns:
        The record.

    Raises:
        CaretreeError: the folder holds a training of something else.
    """
    folder.mkdir(parents=True, exist_ok=True)
    identity = {**about, "seed": seed, "steps": budget.steps, "learning_rate": budget.learning_rate}
    optimiser = torch.optim.Adam(objective.network.parameters(), lr=budget.learning_rate)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, budget.steps)
    checkpoint = folder / "checkpoint.pt"
    done, seconds, losses = 0, 0.0, []
    if checkpoint.exists():
        state = torch.load(checkpoint, weights_only=True)
        if state["identity"] != identity:
            raise CaretreeError(
                f"{folder} holds a training with other settings or data; remove it or choose another folder"
            )
        objective.network.load_state_dict(state["network"])
        optimiser.load_state_dict(state["optimiser"])
        schedule.load_state_dict(state["schedule"])
        done, seconds, losses = state["done"], state["seconds"], state["losses"]
    start = time.process_time()
    objective.network.train()
    recent: list[float] = []
    while done < budget.steps:
        loss = objective.loss(np.random.default_rng((seed, done)))
        optimiser.zero_grad(set_to_none=True)
        loss.backward()
        nn.utils.clip_grad_norm_(objective.network.parameters(), 5.0)
        optimiser.step()
        schedule.step()
        recent.append(float(loss.detach()))
        done += 1
        if done % budget.save_every == 0 or done == budget.steps:
            losses.append(float(np.mean(recent)))
            recent = []
            spent = seconds + time.process_time() - start
            state = {
                "identity": identity,
                "network": objective.network.state_dict(),
                "done": done,
                "seconds": spent,
                "optimiser": optimiser.state_dict(),
                "schedule": schedule.state_dict(),
                "losses": losses,
            }
            torch.save(state, folder / "checkpoint.part")
            os.replace(folder / "checkpoint.part", checkpoint)
            say(
                f"{about.get('method', 'training')} seed {seed}: step {done} of {budget.steps}, loss {losses[-1]:.4g}, "
                f"{spent:.0f} s of processor time"
            )
    if checkpoint.exists():
        seconds = float(torch.load(checkpoint, weights_only=True)["seconds"])
    objective.network.eval()
    record = {**identity, "processor_seconds": round(seconds, 1), "losses": losses, "machine": machine()}
    (folder / "record.json").write_text(json.dumps(record, indent=1) + "\n")
    return record
