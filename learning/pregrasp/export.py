"""A trained policy as ONNX, with the record of its training inside."""

from __future__ import annotations

import io
import json
import os
from pathlib import Path

import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ...sim.errors import CaretreeError
from .affordance import CHANNELS
from .network import PolicyNetwork
from .numbers import VIEWS

FORMAT = "caretree-pregrasp-policy-1"


def export(network: PolicyNetwork, path: Path, record: dict[str, object]) -> Path:
    """Write the network completely or not at all; returns the path.

    Args:
        network: trained.
        path: of the ONNX file.
        record: hash, seed, time, machine: how it came about; kept with the file's metadata.

    Raises:
        CaretreeError: the package `onnx` is missing.
    """
    try:
        import onnx  # pyright: ignore[reportMissingImports] - in the extra `learn`
    except ImportError as error:
        raise CaretreeError("writing the network needs onnx: pip install 'caretree[learn]'") from error
    buffer = io.BytesIO()
    torch.onnx.export(
        network.eval(), (torch.zeros(VIEWS.views, CHANNELS, VIEWS.height, VIEWS.width),),
        buffer,  # pyright: ignore[reportArgumentType] - the exporter without dynamo writes to a buffer too
        dynamo=False, input_names=["views"],
        output_names=["values"],
    )  # fmt: skip
    model = onnx.load_from_string(buffer.getvalue())
    about = {"format": FORMAT, "record": record}
    onnx.helper.set_model_props(model, {key: json.dumps(value) for key, value in about.items()})
    part = path.with_name(path.name + ".part")
    part.write_bytes(model.SerializeToString())
    os.replace(part, path)
    return path
