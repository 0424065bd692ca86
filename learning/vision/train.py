"""Train the network on a dataset, calibrate it, and write it as ONNX with the record of all that."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable
from pathlib import Path

import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ...sim.errors import CaretreeError
from ..physics.networks.training import Budget, fit
from .calibration import calibrate
from .dataset import load_dataset
from .export import export
from .network import SeeingNetwork
from .objective import Seeing

KEPT = 12  # every so many pictures one is kept from the training, for the calibration


def train(
    folder: Path, out: Path, *, steps: int, seed: int, say: Callable[[str], None], start: Path | None = None
) -> Path:
    """Train, or go on with a training.

    Args:
        folder: of the dataset.
        out: gets checkpoint.pt, record.json and seeing.onnx.
        steps: optimiser steps of 8 pictures.
        seed: of weights and batches.
        say: told of progress.
        start: folder of another training whose weights are the first ones.

    Returns:
        The ONNX file.

    Raises:
        CaretreeError: the dataset cannot be used, or `out` holds a training of something else.
    """
    data, digest = load_dataset(folder)
    count = len(data["surface"])
    if count < 2 * KEPT:
        raise CaretreeError(f"{folder} holds {count} pictures; {2 * KEPT} are the fewest to train and calibrate on")
    kept = {key: array[KEPT - 1 :: KEPT] for key, array in data.items()}
    mine = {key: array[[i for i in range(count) if i % KEPT != KEPT - 1]] for key, array in data.items()}
    objective = Seeing(mine, seed)
    about: dict[str, object] = {"method": "seeing", "data": digest, "pictures": len(mine["surface"])}
    if start is not None:
        about["start"] = _begin_with(objective.network, start)
    budget = Budget(steps=steps, learning_rate=2e-3, save_every=min(100, steps))
    record = fit(objective, budget, seed=seed, folder=out, about=about, say=say)
    say(f"calibrating on {len(kept['surface'])} pictures that were kept")
    made = time.strftime("%Y-%m-%d", time.gmtime())
    return export(objective.network, out / "seeing.onnx", {**record, "made": made}, calibrate(objective.network, kept))


def _begin_with(network: SeeingNetwork, folder: Path) -> str:
    """Give a network the weights of another training; returns where these are from, for the record."""
    path = folder / "checkpoint.pt"
    if not path.is_file():
        raise CaretreeError(f"{folder}: there is no training to begin with, it has no checkpoint.pt")
    state = torch.load(path, weights_only=True)
    network.load_state_dict(state["network"])
    digest = hashlib.sha256(path.read_bytes()).hexdigest()[:16]
    return f"{digest}, step {state['done']} of a training with data {state['identity']['data']}"
