"""A trained network as ONNX, with the record of its training inside."""

from __future__ import annotations

import io
import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ...sim.errors import CaretreeError
from .dataset import SIZE
from .labels import KEY_POINTS, SURFACES
from .network import OUTPUTS, SeeingNetwork
from .sheet_nodes import SHEET_NODES

FORMAT = "caretree-seeing-3"
HALF = "half_"  # before the name of weights that the file keeps in half precision


def export(network: SeeingNetwork, path: str | Path, record: dict[str, object], calibration: dict[str, object]) -> Path:
    """Write the network completely or not at all; returns the path.

    Weights are kept in half precision, which halves the file; OpenCV makes them whole again when it reads it.

    Args:
        network: trained; its weights are rounded to what the file keeps.
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
    network = network.eval().to(memory_format=torch.contiguous_format)  # pyright: ignore[reportCallIssue] - its stubs lack it
    with torch.no_grad():
        for weights in network.parameters():
            weights.copy_(weights.half().float())
    buffer = io.BytesIO()
    torch.onnx.export(
        network, (torch.zeros(1, 8, SIZE[1], SIZE[0]),),
        buffer,  # pyright: ignore[reportArgumentType] - the exporter without dynamo writes to a buffer too
        dynamo=False, input_names=["image"],
        output_names=list(OUTPUTS),
    )  # fmt: skip
    model = onnx.load_from_string(buffer.getvalue())
    _keep_half(model)
    about = {
        "format": FORMAT,
        "surfaces": SURFACES,
        "key_points": KEY_POINTS,
        "size": SIZE,
        "sheet_nodes": SHEET_NODES,
        "record": record,
    } | calibration
    onnx.helper.set_model_props(model, {key: json.dumps(value) for key, value in about.items()})
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    part.write_bytes(model.SerializeToString())
    os.replace(part, path)
    return path


def _keep_half(model: Any) -> None:
    """Let the model keep its weights in half precision, each followed by a cast to what it is computed in."""
    import onnx  # pyright: ignore[reportMissingImports] - in the extra `learn`

    casts = []
    for tensor in model.graph.initializer:
        if tensor.data_type != onnx.TensorProto.FLOAT or len(tensor.dims) < 1:
            continue
        half = onnx.numpy_helper.to_array(tensor).astype(np.float16)
        tensor.CopyFrom(onnx.numpy_helper.from_array(half, HALF + tensor.name))
        whole = tensor.name.removeprefix(HALF)
        casts.append(onnx.helper.make_node("Cast", [tensor.name], [whole], to=onnx.TensorProto.FLOAT))
    nodes = [*casts, *model.graph.node]
    del model.graph.node[:]
    model.graph.node.extend(nodes)
