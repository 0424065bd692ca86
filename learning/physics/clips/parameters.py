"""The six parameters of a gown that are learned, and their map to [0, 1].

All scales are logarithmic: every law in the gown is a product of a parameter with something else, so a clip answers
to the ratio of two values and not to their difference, and the error is told in per cent.  On a linear scale the
lowest tenth of the range would hold a factor of six, and the upper half only a factor of two.  What a clip shows on
these scales is measured in `docs/garment-physics.md`.

The ranges run from a tenth to five times the base value, but for two: a gown above 0.9 kg or with springs below
18 N/m stretches so far under its own weight (edges at the held vertices to three times their length) that it hangs
out of the picture and is no cloth any more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....sim.errors import CaretreeError
from ....sim.scene.gown import GownSpec


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """One number of a gown.

    Attributes:
        name: its field in `GownSpec`.
        unit: what it is counted in.
        base: usual value.
        low: value at 0.
        high: value at 1.
        shown: whether a clip depends on it at all.
    """

    name: str
    unit: str
    base: float
    low: float
    high: float
    shown: bool = True


PARAMETERS: tuple[Parameter, ...] = (
    Parameter(name="mass", unit="kg", base=0.45, low=0.045, high=0.9),
    Parameter(name="elastic", unit="N/m", base=45.0, low=18.0, high=225.0),
    Parameter(name="bending", unit="N/m", base=0.1, low=0.01, high=0.5),
    Parameter(name="damping", unit="N s/m", base=0.006, low=0.0006, high=0.03),
    # nothing touches a falling gown, and cloth does not rub on itself in this world: the clip cannot show it
    Parameter(name="friction", unit="1", base=0.4, low=0.04, high=2.0, shown=False),
    Parameter(name="air_drag", unit="N s^2/m^4", base=0.3, low=0.03, high=1.5),
)
NAMES: tuple[str, ...] = tuple(p.name for p in PARAMETERS)
SHOWN: tuple[int, ...] = tuple(k for k, p in enumerate(PARAMETERS) if p.shown)  # indices a clip can tell
LOW = np.array([p.low for p in PARAMETERS])
HIGH = np.array([p.high for p in PARAMETERS])
BASE = np.array([p.base for p in PARAMETERS])


def values_of(spec: GownSpec) -> np.ndarray:
    """(6,) the parameters of a gown in their own units."""
    return np.array([float(getattr(spec, name)) for name in NAMES])


def to_values(unit: np.ndarray) -> np.ndarray:
    """(..., 6) in [0, 1] -> the same in their own units."""
    return LOW * (HIGH / LOW) ** np.asarray(unit, float)


def values_to_unit(values: np.ndarray) -> np.ndarray:
    """(..., 6) in their own units -> the same on the scale where the range is [0, 1].

    Raises:
        CaretreeError: a value is not above zero.
    """
    values = np.asarray(values, float)
    if not np.all(values > 0):
        raise CaretreeError(f"{', '.join(NAMES)} must be above zero to have a place on their logarithmic scales")
    return np.log(values / LOW) / np.log(HIGH / LOW)


def to_unit(spec: GownSpec) -> np.ndarray:
    """(6,) the parameters of a gown on the scale where the range is [0, 1].

    Raises:
        CaretreeError: a value is not above zero.
    """
    return values_to_unit(values_of(spec))


def to_spec(unit: np.ndarray, base: GownSpec) -> GownSpec:
    """A gown cut like `base` with the six parameters of `unit`, (6,).

    Raises:
        CaretreeError: not six finite numbers.
    """
    unit = np.asarray(unit, float)
    if unit.shape != (len(NAMES),) or not np.all(np.isfinite(unit)):
        raise CaretreeError(f"{len(NAMES)} finite numbers are asked for, {', '.join(NAMES)}, not shape {unit.shape}")
    return replace(base, **dict(zip(NAMES, to_values(unit).tolist(), strict=True)))
