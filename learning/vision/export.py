"""A trained network as ONNX, with the record of its training inside."""

from __future__ import annotations

import io
import json
import os
from pathlib import Path

import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ...sim.errors import CaretreeError
from .dataset import FORMAT, SIZE
from .labels import KEY_POINTS, SURFACES
from .network import OUTPUTS, SeeingNetwork


def export(network: SeeingNetwork, path: str | Path, record: dict[str, object], calibration: dict[str, object]) -> Path:
    """Write the network completely or not at all; returns the path.

    Args:
        network: trained.
        path: of the ONNX file.
        record: hash, seed, time, machine: how it came about; kept with the file's metadata.
        calibration: of `calibrate`.

    Raises:
        CaretreeError: the package `onnx` is missing.
    """
    try:
        import onnx  # pyright: ignore[reportMissingImports] - in the extra `learn`
    except ImportError as error:
        raise CaretreeError("writing the network needs onnx: pip install 'caretree[learn]'") from error
    network = network.eval().to(memory_format=torch.contiguous_format)
    buffer = io.BytesIO()
    torch.onnx.export(
        network, (torch.zeros(1, 5, SIZE[1], SIZE[0]),), buffer, dynamo=False, input_names=["image"],
        output_names=list(OUTPUTS),
    )  # fmt: skip
    model = onnx.load_from_string(buffer.getvalue())
    about = {
        "format": FORMAT,
        "surfaces": SURFACES,
        "key_points": KEY_POINTS,
        "size": SIZE,
        "record": record,
    } | calibration
    onnx.helper.set_model_props(model, {key: json.dumps(value) for key, value in about.items()})
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    part.write_bytes(model.SerializeToString())
    os.replace(part, path)
    return path
