"""A trained policy as ONNX, with the record of its training inside."""

from __future__ import annotations

import io
import json
import os
from pathlib import Path
from typing import Any

import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ...sim.errors import CaretreeError
from ...sim.pregrasp.affordance import CHANNELS
from ...sim.pregrasp.numbers import VIEWS
from ...sim.pregrasp.policy import FORMAT, TOGETHER
from ...sim.pregrasp.surroundings import CELLS
from .grasp_network import GraspNetwork
from .network import PolicyNetwork


def export(network: PolicyNetwork, path: Path, record: dict[str, object]) -> Path:
    """Write the network that looks at pictures completely or not at all; returns the path.

    Args:
        network: trained.
        path: of the ONNX file.
        record: hash, seed, time, machine: how it came about; kept with the file's metadata.

    Raises:
        CaretreeError: the package `onnx` is missing.
    """
    given = {"views": torch.zeros(VIEWS.views, CHANNELS, VIEWS.height, VIEWS.width)}
    return _write(network, path, given, {"views": VIEWS.views, "record": record})


def export_grasps(
    network: GraspNetwork, path: Path, record: dict[str, object], calibration: tuple[float, float]
) -> Path:
    """Write the network that tells what fingers take; arguments as of `export`.

    Args:
        network: trained.
        path: of the ONNX file.
        record: how it came about.
        calibration: scale and shift from an action's value to the logit of its success.

    Raises:
        CaretreeError: the package `onnx` is missing.
    """
    given = {"cells": torch.zeros(TOGETHER, CELLS.up, CELLS.along, CELLS.across), "corners": torch.zeros(TOGETHER, 3)}
    return _write(network, path, given, {"calibration": calibration, "record": record})


def export_reward(network: torch.nn.Module, path: Path, record: dict[str, object]) -> Path:
    """Write the network that tells success by what lies around the hand; arguments as of `export`.

    Raises:
        CaretreeError: the package `onnx` is missing.
    """
    given = {"cells": torch.zeros(1, CELLS.up, CELLS.along, CELLS.across)}
    return _write(network, path, given, {"reward": True, "record": record})


def _write(network: torch.nn.Module, path: Path, given: dict[str, torch.Tensor], about: dict[str, Any]) -> Path:
    try:
        import onnx  # pyright: ignore[reportMissingImports] - in the extra `learn`
    except ImportError as error:
        raise CaretreeError("writing the network needs onnx: pip install 'caretree[learn]'") from error
    buffer = io.BytesIO()
    torch.onnx.export(
        network.eval(), tuple(given.values()),
        buffer,  # pyright: ignore[reportArgumentType] - the exporter without dynamo writes to a buffer too
        dynamo=False, input_names=list(given), output_names=["logits"],
    )  # fmt: skip
    model = onnx.load_from_string(buffer.getvalue())
    about = {"format": FORMAT, **about}
    onnx.helper.set_model_props(model, {key: json.dumps(value) for key, value in about.items()})
    part = path.with_name(path.name + ".part")
    part.write_bytes(model.SerializeToString())
    os.replace(part, path)
    return path
