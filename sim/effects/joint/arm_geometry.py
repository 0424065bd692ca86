"""Where an arm stands and where its joints' zeros are: a tilted base, an encoder whose zero is off."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..effect import Parameter

if TYPE_CHECKING:
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

MOST = 0.5  # beyond which nobody would have set an arm up so [rad]
TILT = tuple(Parameter(name=f"about_{a}", unit="rad", lower=-MOST, upper=MOST, typical=0.02) for a in "xyz")
ZERO = Parameter(name="angle", unit="rad", lower=-MOST, upper=MOST, typical=0.02)
GEOMETRY = {"base_tilt": TILT, "encoder_offset": (ZERO,)}
BASE = "base"  # target of a tilt
STEP = 1e-4  # of the slope of gravity over a turn [rad]
WAY, WEIGHTS = (0.5 - np.sqrt(0.15), 0.5, 0.5 + np.sqrt(0.15)), (5.0, 8.0, 5.0)  # Gauss's three points from 0 to 1


def tilts(gravity: np.ndarray) -> tuple[Parameter, ...]:
    """The two axes of the base about which a tilt changes what gravity does: those least along it.

    Args:
        gravity: (3,) acceleration in the base's frame [m/s^2].
    """
    return tuple(TILT[k] for k in sorted(np.argsort(np.abs(gravity), kind="stable")[:2]))


def tilted(gravity: np.ndarray, values: dict[str, float]) -> np.ndarray:
    """(3,) gravity in the frame of a base that stands turned by a rotation vector of `about_x`, `_y`, `_z` [rad]."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_rotvec([values.get(p.name, 0.0) for p in TILT]).inv().apply(gravity)


def tilt_changes(gravity: np.ndarray, names: list[str], at: dict[str, float]) -> list[np.ndarray]:
    """(3,) by which gravity in the base's frame changes per turn about each axis: times the turns `at`, all of it.

    Args:
        gravity: (3,) without a tilt [m/s^2].
        names: of the axes, as in `TILT`.
        at: the turn at which the changes are exact [rad].
    """
    out = []
    for name in names:
        ways = []
        for share in WAY:  # the mean slope between no turn and this one
            there = {n: share * x for n, x in at.items()}
            ends = [tilted(gravity, {**there, name: there.get(name, 0.0) + s}) for s in (-STEP, STEP)]
            ways.append((ends[1] - ends[0]) / (2.0 * STEP))
        out.append(np.average(ways, axis=0, weights=WEIGHTS))
    return out


def with_tilted_base(model: pin.Model, values: dict[str, float]) -> pin.Model:
    """A copy of a pinocchio model whose base stands turned by a rotation vector [rad]."""
    out = model.copy()
    out.gravity.linear = tilted(np.asarray(model.gravity.linear), values)
    return out
