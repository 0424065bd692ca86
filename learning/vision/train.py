"""Train the network on a dataset, calibrate it, and write it as ONNX with the record of all that."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ...sim.errors import CaretreeError
from ..physics.networks.training import Budget, fit
from .calibration import calibrate
from .dataset import load_dataset
from .export import HALF, export
from .network import SeeingNetwork
from .objective import Seeing

KEPT = 12  # every so many pictures one is kept from the training, for the calibration
RATE = 2e-3  # of learning, at the start


def train(
    folders: Sequence[Path],
    out: Path,
    *,
    steps: int,
    seed: int,
    say: Callable[[str], None],
    start: Path | None = None,
    apart: Path | None = None,
    learning_rate: float = RATE,
    mean_with: Path | None = None,
) -> Path:
    """Train, or go on with a training.

    Args:
        folders: of one dataset or more.
        out: gets checkpoint.pt, record.json and seeing.onnx.
        steps: optimiser steps of 8 pictures.
        seed: of weights and batches.
        say: told of progress.
        start: folder of another training, or a network in an ONNX file; weights of its that fit are the first ones.
        apart: folder of a dataset to calibrate on, best of rooms that no training picture shows: in rooms that it
            knows the network is right more often.  None keeps every twelfth picture of `folders` from the training.
        learning_rate: at the start.
        mean_with: another training or ONNX file; the mean of its weights and the trained ones is calibrated and
            written: trained on from there with other data, each is better at other pictures.

    Returns:
        The ONNX file.

    Raises:
        CaretreeError: a dataset cannot be used, or `out` holds a training of something else.
    """
    loaded = [load_dataset(folder) for folder in folders]
    data = {key: np.concatenate([arrays.pop(key) for arrays, _ in loaded]) for key in list(loaded[0][0])}
    digest = " ".join(digest for _, digest in loaded)
    count = len(data["surface"])
    if count < 2 * KEPT:
        where = ", ".join(map(str, folders))
        raise CaretreeError(f"{where}: {count} pictures; {2 * KEPT} are the fewest to train and calibrate on")
    mine, kept = data, {}
    if apart is None:
        kept = {key: array[KEPT - 1 :: KEPT] for key, array in data.items()}
        mine = {key: array[[i for i in range(count) if i % KEPT != KEPT - 1]] for key, array in data.items()}
    objective = Seeing(mine, seed)
    network = objective.network
    assert isinstance(network, SeeingNetwork)
    about: dict[str, object] = {"method": "seeing", "data": digest, "pictures": len(mine["surface"])}
    if apart is not None:
        kept, about["apart"] = load_dataset(apart)
    if start is not None:
        about["start"] = _begin_with(network, start)
    budget = Budget(steps=steps, learning_rate=learning_rate, save_every=min(100, steps))
    record = fit(objective, budget, seed=seed, folder=out, about=about, say=say)
    if mean_with is not None:
        other = SeeingNetwork()
        record["mean_with"] = _begin_with(other, mean_with)
        with torch.no_grad():
            for weights, others in zip(network.parameters(), other.parameters(), strict=True):
                weights.lerp_(others, 0.5)
    say(f"calibrating on {len(kept['surface'])} pictures that were not trained on")
    made = time.strftime("%Y-%m-%d", time.gmtime())
    return export(network, out / "seeing.onnx", {**record, "made": made}, calibrate(network, kept))


def _begin_with(network: SeeingNetwork, start: Path) -> str:
    """Give a network the weights of another that have its names and sizes; returns where these are from.

    Raises:
        CaretreeError: there is no such training or file, or nothing of it fits.
    """
    path = start if start.suffix == ".onnx" else start / "checkpoint.pt"
    if not path.is_file():
        raise CaretreeError(f"{start}: there is no training to begin with, no checkpoint.pt and no ONNX file")
    if path.suffix == ".onnx":
        weights, of = _read_onnx(path)
        done, data = of["steps"], of["data"]
    else:
        state = torch.load(path, weights_only=True)
        weights, done, data = state["network"], state["done"], state["identity"]["data"]
    own = network.state_dict()
    weights = {name: _widened(w, own[name]) if name in own else w for name, w in weights.items()}
    fitting = {name: w for name, w in weights.items() if name in own and own[name].shape == w.shape}
    if not fitting:
        raise CaretreeError(f"{path}: none of its weights fits the network")
    network.load_state_dict(own | fitting)
    digest = hashlib.sha256(path.read_bytes()).hexdigest()[:16]
    return f"{len(fitting)} of {len(own)} weights of {digest}, step {done} of a training with data {data}"


def _widened(weights: torch.Tensor, wanted: torch.Tensor) -> torch.Tensor:
    """Weights of a layer that was told less, which makes nothing of the inputs that have come since."""
    if weights.ndim != 4 or weights.shape[1] >= wanted.shape[1] or weights.shape[::2] != wanted.shape[::2]:
        return weights
    return torch.cat([weights, torch.zeros_like(wanted[:, weights.shape[1] :])], 1)


def _read_onnx(path: Path) -> tuple[dict[str, torch.Tensor], dict[str, Any]]:
    """Name -> weights in an ONNX file that `export` wrote, and the record of their training."""
    import onnx  # pyright: ignore[reportMissingImports] - in the extra `learn`

    model = onnx.load(str(path))
    about = {each.key: each.value for each in model.metadata_props}
    to_array = onnx.numpy_helper.to_array
    weights = {
        each.name.removeprefix(HALF): torch.from_numpy(to_array(each).astype(np.float32))
        for each in model.graph.initializer
    }
    return weights, json.loads(about["record"])
