"""The study for the system of a measurement set."""

from __future__ import annotations

from typing import Any

from .errors import GapError
from .measurement import MeasurementSet
from .own.find_system import find_system, installed
from .own.system import System
from .study import Study


def open_study(
    measured: MeasurementSet, alpha: float = 0.05, cache: Any = None, own: System | None = None, source: str = ""
) -> Study:
    """The study for a set's system.

    Args:
        measured: the set.
        alpha: level of the tests.
        cache: folder for what simulations of cloth and of dressing gave, or None.
        own: the user's simulator, where it is none of the built-in ones.
        source: where that comes from, for model.yaml.

    Raises:
        GapError: the set lacks what its system needs.
    """
    if own is None and measured.system in installed():
        own, source = find_system(measured.system), measured.system
    if own is not None:
        if own.name != measured.system:
            raise GapError(
                f"{measured.folder / 'measurement.yaml'}: system is {measured.system!r}, {type(own).__name__} is "
                f"for {own.name!r}"
            )
        from .own.study import OwnStudy

        return OwnStudy(measured, alpha, own, source)
    if measured.system in ("arm", "axis"):
        from .joints.study import JointStudy

        return JointStudy(measured, alpha)
    if measured.system == "fall":
        from .fall.study import FallStudy

        return FallStudy(measured, alpha)
    if measured.system == "dressing":
        from .dressing.study import DressingStudy

        return DressingStudy(measured, alpha, cache)
    from .cloth.study import ClothStudy

    return ClothStudy(measured, alpha, cache=cache)
