"""Write a measurement set: the yaml and its tables."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import yaml

from ..table import write_table


def write_set(
    folder: Path,
    header: dict[str, Any],
    episodes: list[tuple[str, str, dict[str, np.ndarray]]],
    pins: list[list[dict[str, Any]]] | None = None,
) -> Path:
    """Write `measurement.yaml` and one CSV per (name, role, columns), for cloth with the pins of each.

    Returns:
        The folder.
    """
    folder.mkdir(parents=True, exist_ok=True)
    listed = []
    for k, (name, role, columns) in enumerate(episodes):
        write_table(folder / f"{name}.csv", columns)
        listed.append({"file": f"{name}.csv", "role": role, **({"pins": pins[k]} if pins else {})})
    (folder / "measurement.yaml").write_text(yaml.safe_dump({**header, "episodes": listed}, sort_keys=False))
    return folder
