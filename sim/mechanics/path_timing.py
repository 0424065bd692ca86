"""The library that times paths of joints, without what it imports and a run never uses, or has cheaper."""

from __future__ import annotations

import importlib
import sys
import types
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

from ..extras import put_off
from .cubic_spline import CubicSpline

SPLINES = "scipy.interpolate"


@cache
def toppra() -> Any:
    """The package; loading what it can draw and interpolate with would take as long as timing sixty motions."""
    with put_off("matplotlib", "pyplot"), _own_splines():
        import toppra as package
    return package


@contextmanager
def _own_splines() -> Iterator[None]:
    """Let what is imported meanwhile take its cubic splines from here, and load others when it makes some."""
    scipys, ours = sys.modules.get(SPLINES), types.ModuleType(SPLINES)
    vars(ours).update(
        CubicSpline=CubicSpline, **{name: _Scipys(name) for name in ("BPoly", "PPoly", "UnivariateSpline")}
    )
    sys.modules[SPLINES] = ours
    try:
        yield
    finally:
        if scipys is None:
            del sys.modules[SPLINES]
        else:
            sys.modules[SPLINES] = scipys


class _Scipys:
    """Stands for scipy's class of this name until something is made of it."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        return getattr(importlib.import_module(SPLINES), self._name)(*args, **kwargs)

    def __getattr__(self, name: str) -> Any:
        return getattr(getattr(importlib.import_module(SPLINES), self._name), name)
