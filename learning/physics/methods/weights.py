"""A fitted GP inversion as one safetensors file, which numpy alone can read."""

from __future__ import annotations

import json
import os
from dataclasses import fields
from pathlib import Path

import numpy as np

from ....sim.errors import CaretreeError
from ..clips.parameters import HIGH, LOW, NAMES
from .conformal import Calibration
from .gaussian_process import GaussianProcess
from .gp_inversion import SORTS, GPInversion
from .inversion import Inversion, Widths
from .pca import Compression
from .prior import Prior

FORMAT = "caretree-garment-physics-3"
PACKAGED = Path(__file__).parents[1] / "weights" / "gp_inversion.safetensors"
_SMALL = {"compression.components": np.int8, "process.inputs": np.float32}  # kept in fewer bits


def _ranges() -> str:
    return json.dumps([NAMES, LOW.tolist(), HIGH.tolist()])


def _arrays(prefix: str, part: object) -> dict[str, np.ndarray]:
    """The fields of a dataclass by name."""
    return {f"{prefix}.{f.name}": np.asarray(getattr(part, f.name)) for f in fields(part)}  # type: ignore[arg-type]


def _inversion_arrays(inversion: Inversion) -> dict[str, np.ndarray]:
    arrays = {
        **_arrays("compression", inversion.compression),
        **_arrays("process", inversion.process),
        "prior.means": inversion.prior.means,
        "prior.variance": inversion.prior.variance,
    }
    for way, widths in inversion.widths.items():
        arrays |= {**_arrays(f"{way}.before", widths.before), **_arrays(f"{way}.after", widths.after)}
    return {name: np.ascontiguousarray(array, _SMALL.get(name, array.dtype)) for name, array in arrays.items()}


def save_weights(method: GPInversion, path: str | Path, record: dict[str, object]) -> Path:
    """Write the method completely or not at all; `record` says how it came about.  Returns the path."""
    from safetensors.numpy import save_file  # pyright: ignore[reportMissingImports] - in the extra `learn`

    path = Path(path)
    tensors = {
        f"{sort}/{name}": array
        for sort, one in method.inversions.items()
        for name, array in _inversion_arrays(one).items()
    }
    about = {
        "format": FORMAT,
        "ranges": _ranges(),
        "shown": json.dumps(method.sort(False).shown),
        "record": json.dumps(record),
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    save_file(tensors, part, metadata=about)
    part.chmod(0o644)  # safetensors leaves it readable by its owner only
    os.replace(part, path)
    return path


def load_weights(path: str | Path = PACKAGED) -> tuple[GPInversion, dict]:
    """The method in a file, and its record.

    Raises:
        CaretreeError: the file is missing, holds no GP inversion, or was made for other parameter ranges; or the
            package `safetensors` is missing.
    """
    try:
        from safetensors import SafetensorError, safe_open  # pyright: ignore[reportMissingImports] - extra `learn`
    except ImportError as error:
        raise CaretreeError("reading weights needs safetensors: pip install 'caretree[learn]'") from error
    path = Path(path)
    if not path.is_file():
        raise CaretreeError(
            f"{path}: there are no such weights; `caretree learn physics train DATA --method gp_inversion "
            "--out DIR` makes them, DIR/gp_inversion.safetensors"
        )
    try:
        with safe_open(path, "numpy") as file:
            about = file.metadata() or {}
            tensors = {key: file.get_tensor(key) for key in file.keys()}  # noqa: SIM118 (it is no dict)
    except SafetensorError as error:
        raise CaretreeError(f"{path}: this is no file of weights (safetensors)") from error
    if about.get("format") != FORMAT or about.get("ranges") != _ranges():
        raise CaretreeError(f"{path}: the weights are not in format {FORMAT} or were made for other parameter ranges")
    shown = tuple(json.loads(about["shown"]))
    read = {
        sort: _inversion(
            {name.removeprefix(f"{sort}/"): array for name, array in tensors.items() if name.startswith(f"{sort}/")},
            shown,
        )
        for sort in SORTS.values()
        if f"{sort}/process.inputs" in tensors
    }
    return GPInversion(read), json.loads(about["record"])


def _inversion(tensors: dict[str, np.ndarray], shown: tuple[int, ...]) -> Inversion:
    def part(prefix: str) -> dict[str, np.ndarray]:
        return {k.removeprefix(prefix): v for k, v in tensors.items() if k.startswith(prefix)}

    compression, process = Compression(**part("compression.")), part("process.")
    process["inputs"] = process["inputs"].astype(float)
    widths = {
        way: Widths(**{stage: _calibration(part(f"{way}.{stage}.")) for stage in ("before", "after")})
        for way in sorted({key.split(".")[0] for key in tensors if key.endswith(".after.factor")})
    }
    return Inversion(compression, GaussianProcess(**process), Prior(**part("prior.")), widths, shown)


def _calibration(tensors: dict[str, np.ndarray]) -> Calibration:
    arrays = {name: array for name, array in tensors.items() if name != "usual_misfit"}
    return Calibration(usual_misfit=float(tensors["usual_misfit"][0]), **arrays)
