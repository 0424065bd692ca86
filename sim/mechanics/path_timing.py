"""The library that times paths of joints, without the plotting library that it imports and a run never uses."""

from __future__ import annotations

from functools import cache
from typing import Any

from ..extras import put_off


@cache
def toppra() -> Any:
    """The package; loading what it can draw with would take as long as timing thirty motions."""
    with put_off("matplotlib", "pyplot"):
        import toppra as package
    return package
