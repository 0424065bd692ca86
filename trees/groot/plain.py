"""Values of the board as plain numbers, texts, lists and dictionaries, which other programs can show."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

MOST = 64  # numbers of an array, or entries of a list, that are shown; of larger ones only what they are
DEEPEST = 6
LONGEST = 200  # characters


def plain(value: Any, depth: int = 0) -> Any:
    """`value` as others can show it."""
    if isinstance(value, (bool, int, str)) or value is None:
        return value if not isinstance(value, int) or abs(value) < 2**63 else str(value)
    if isinstance(value, (float, np.floating)):
        return float(value) if math.isfinite(value) else str(float(value))
    if isinstance(value, np.generic):
        return plain(value.item(), depth + 1)
    if isinstance(value, np.ndarray):
        if value.size > MOST:
            return f"array {value.shape} of {value.dtype}"
        return plain(value.tolist(), depth)
    if depth < DEEPEST:
        if dataclasses.is_dataclass(value) and not isinstance(value, type):
            return {each.name: plain(getattr(value, each.name), depth + 1) for each in dataclasses.fields(value)}
        if isinstance(value, Mapping) and len(value) <= MOST:
            return {str(key): plain(each, depth + 1) for key, each in value.items()}
        if isinstance(value, (list, tuple)) and len(value) <= MOST:
            return [plain(each, depth + 1) for each in value]
    return " ".join(str(value).split())[:LONGEST]
