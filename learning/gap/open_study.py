"""The study for the system of a measurement set."""

from __future__ import annotations

from typing import Any

from .measurement import MeasurementSet
from .study import Study


def open_study(measured: MeasurementSet, alpha: float = 0.05, cache: Any = None) -> Study:
    """The study for a set's system.

    Raises:
        GapError: the set lacks what its system needs.
    """
    if measured.system in ("arm", "axis"):
        from .joints.study import JointStudy

        return JointStudy(measured, alpha)
    if measured.system == "fall":
        from .fall.study import FallStudy

        return FallStudy(measured, alpha)
    from .cloth.study import ClothStudy

    return ClothStudy(measured, alpha, cache=cache)
