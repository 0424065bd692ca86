"""Packages that the core does without: imported with their first use, and their extra named where they are missing.

    pin: Any = later("pinocchio")        # at the top of a file of the core; nothing is imported yet

The core is numpy and py_trees: trees, the base of the skills, the guard, the scripted world, records and XML.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
import types
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from .errors import CaretreeError

# What is imported -> the extra of setup.cfg that brings it; a test compares.
EXTRA_OF = {
    "PIL": "sim",
    "av": "sim",
    "coal": "sim",
    "cv2": "sim",
    "filterpy": "sim",
    "h5py": "gap",
    "lz4": "log",
    "matplotlib": "view",
    "mcap": "log",
    "msgpack": "remote",
    "numba": "sim",
    "onnx": "learn",
    "openpyxl": "gap",
    "orjson": "log",
    "pinocchio": "sim",
    "pooch": "gap",
    "pyarrow": "lerobot",
    "pybullet": "sim",
    "pybullet_utils": "sim",
    "pysindy": "gap",
    "ray": "ray",
    "ruptures": "gap",
    "safetensors": "learn",
    "scipy": "sim",
    "sklearn": "learn",
    "toppra": "sim",
    "torch": "learn",
    "viser": "view",
    "yaml": "yaml",
    "zmq": "groot",
}


class MissingExtra(CaretreeError):  # noqa: N818 it names a state of the installation
    """What was asked for needs a package that this installation is without."""

    def __init__(self, package: str, what: str = "this", extra: str | None = None) -> None:
        self.package, self.what, self.extra = package, what, extra or EXTRA_OF[package]
        super().__init__(f"{what} needs {package}, which is not installed: pip install 'caretree[{self.extra}]'")


def missing_extra(error: ModuleNotFoundError | MissingExtra, extra: str | None = None) -> MissingExtra | None:
    """The sentence about a package that could not be imported; None for one that no extra brings.

    Args:
        error: of the import.
        extra: that brings all that the command needs, if one does.
    """
    if isinstance(error, MissingExtra):
        return MissingExtra(error.package, error.what, extra or error.extra)
    package = (error.name or "").partition(".")[0]
    return MissingExtra(package, extra=extra) if package in EXTRA_OF else None


def need(package: str, what: str = "this") -> None:
    """Refuse at once what could only fail later.

    Args:
        package: that it needs.
        what: needs it.

    Raises:
        MissingExtra: it is not installed.
    """
    if importlib.util.find_spec(package) is None:
        raise MissingExtra(package, what)


class Later(types.ModuleType):
    """Stands for a package until something of it is used."""

    def __getattr__(self, name: str) -> Any:
        """Import the package; what has been asked for once is found at once from then on.

        Raises:
            MissingExtra: it is not installed.
        """
        if name.startswith("__"):  # asked for by tools that look at every module
            raise AttributeError(name)
        try:
            package = importlib.import_module(self.__name__)
        except ModuleNotFoundError as error:
            raise missing_extra(error) or error from error
        value = getattr(package, name)
        setattr(self, name, value)
        return value


def later(package: str) -> Any:
    """The package of this name, imported when something of it is first used."""
    return Later(package)


@contextmanager
def put_off(package: str, module: str) -> Iterator[None]:
    """Let what is imported meanwhile have `package.module` imported only when it uses something of it.

    For packages that import at their top what a run never uses; nothing else of `package` can be had meanwhile.
    """
    if package in sys.modules:
        yield
        return
    parent, child = types.ModuleType(package), later(f"{package}.{module}")
    setattr(parent, module, child)
    sys.modules.update({parent.__name__: parent, child.__name__: child})
    try:
        yield
    finally:
        for stand_in in (parent, child):
            del sys.modules[stand_in.__name__]
