"""Our fitted method as one safetensors file."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from safetensors import SafetensorError, safe_open  # pyright: ignore[reportMissingImports] - in the extra `learn`
from safetensors.torch import save_file  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ...sim.errors import CaretreeError
from .compression import Compression
from .conformal import Calibration
from .gaussian_process import GaussianProcess
from .ours import Inversion, Widths
from .parameters import HIGH, LOW, NAMES
from .prior import Prior

FORMAT = "caretree-garment-physics-1"
PACKAGED = Path(__file__).parent / "weights" / "ours.safetensors"


def _ranges() -> str:
    return json.dumps([NAMES, LOW.tolist(), HIGH.tolist()])


def save_weights(method: Inversion, path: str | Path, record: dict[str, object]) -> Path:
    """Write the method completely or not at all; `record` says how it came about.  Returns the path."""
    path = Path(path)
    tensors = {f"compression.{k}": v.half() if k == "components" else v
               for k, v in method.compression.state_dict().items()}
    tensors |= {f"process.{k}": v for k, v in method.process.state_dict().items()}
    tensors["prior.means"] = torch.from_numpy(method.prior.means)
    tensors["prior.variance"] = torch.from_numpy(method.prior.variance)
    for way, widths in method.widths.items():
        for stage in ("before", "after"):
            one: Calibration = getattr(widths, stage)
            tensors |= {f"{way}.{stage}.places": torch.from_numpy(one.places).float(),
                        f"{way}.{stage}.errors": torch.from_numpy(one.errors).float(),
                        f"{way}.{stage}.factor": torch.from_numpy(one.factor),
                        f"{way}.{stage}.usual_misfit": torch.tensor([one.usual_misfit])}
    about = {"format": FORMAT, "ranges": _ranges(), "shown": json.dumps(method.shown), "record": json.dumps(record)}
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    save_file({k: v.contiguous() for k, v in tensors.items()}, part, metadata=about)
    part.chmod(0o644)  # safetensors leaves it readable by its owner only
    os.replace(part, path)
    return path


def load_weights(path: str | Path = PACKAGED) -> tuple[Inversion, dict[str, object]]:
    """The method in a file, and its record.

    Raises:
        CaretreeError: the file is missing, is none of ours, or was made for other parameter ranges.
    """
    path = Path(path)
    if not path.is_file():
        raise CaretreeError(f"{path}: there are no such weights; `caretree learn physics train DATA --method ours "
                            "--out DIR` makes them, DIR/ours.safetensors")
    try:
        with safe_open(path, "pt") as file:
            about = file.metadata() or {}
            tensors = {key: file.get_tensor(key) for key in file.keys()}  # noqa: SIM118 (it is no dict)
    except SafetensorError as error:
        raise CaretreeError(f"{path}: this is no file of weights (safetensors)") from error
    if about.get("format") != FORMAT or about.get("ranges") != _ranges():
        raise CaretreeError(f"{path}: the weights are not in format {FORMAT} or were made for other parameter ranges")

    def part(prefix: str) -> dict[str, torch.Tensor]:
        return {k.removeprefix(prefix): v for k, v in tensors.items() if k.startswith(prefix)}

    def array(key: str) -> np.ndarray:
        return tensors[key].double().numpy()

    squeeze = part("compression.")
    compression = Compression(squeeze["mean"], squeeze["components"].float(), squeeze["scale"])
    process = GaussianProcess(**part("process."))
    widths = {}
    for way in ("alone", "simulated"):
        if f"{way}.after.factor" in tensors:
            widths[way] = Widths(**{stage: Calibration(
                places=array(f"{way}.{stage}.places"), errors=array(f"{way}.{stage}.errors"),
                factor=array(f"{way}.{stage}.factor"), usual_misfit=float(array(f"{way}.{stage}.usual_misfit")[0]),
            ) for stage in ("before", "after")})  # fmt: skip
    prior = Prior(array("prior.means"), array("prior.variance"))
    shown = tuple(json.loads(about["shown"]))
    return Inversion(compression, process, prior, widths, shown), json.loads(about["record"])
