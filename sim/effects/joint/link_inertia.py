"""Change what a link of a pinocchio model weighs: a wrong link mass, a payload, a wrong or missing tool."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..effect import EffectError, Parameter

if TYPE_CHECKING:
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

BODY_PARAMETERS = (Parameter(name="mass", unit="kg"), *(Parameter(name=f"mass_com_{a}", unit="kg m") for a in "xyz"))
BODY_TERMS = ("payload", "wrong_tool")


def with_point_mass(model: pin.Model, joint: str, values: dict[str, float]) -> pin.Model:
    """A copy of the model with a point mass added to (or, where negative, taken from) the link after `joint`.

    Args:
        model: pinocchio model.
        joint: joint that carries the link.
        values: `mass` [kg] and its first moment `mass_com_x`, `_y`, `_z` [kg m] in the joint's frame.

    Raises:
        EffectError: the model has no such joint.
    """
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

    index = _joint(model, joint)
    mass = values["mass"]
    com = np.array([values.get(f"mass_com_{a}", 0.0) for a in "xyz"]) / (mass if abs(mass) > 1e-9 else 1.0)
    change = pin.Inertia(1.0, com, np.zeros((3, 3))).toDynamicParameters() * mass
    return _changed(model, index, change)


def with_scaled_mass(model: pin.Model, joint: str, mass: float) -> pin.Model:
    """A copy of the model whose link after `joint` weighs `mass` [kg] more, its shape of mass kept.

    Raises:
        EffectError: the model has no such joint.
    """
    index = _joint(model, joint)
    inertia = model.inertias[index]
    return _changed(model, index, inertia.toDynamicParameters() * (mass / inertia.mass))


def _joint(model: pin.Model, joint: str) -> int:
    if not model.existJointName(joint):
        raise EffectError(f"the model has no joint '{joint}', it has {', '.join(list(model.names)[1:])}")
    return model.getJointId(joint)


def _changed(model: pin.Model, index: int, change: np.ndarray) -> pin.Model:
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

    out = model.copy()
    out.inertias[index] = pin.Inertia.FromDynamicParameters(model.inertias[index].toDynamicParameters() + change)
    return out
