"""One prismatic axis: a mass on a rail."""

from __future__ import annotations

import numpy as np

from ....sim.effects.effect import Parameter
from .rigid import BodyTerm, RigidModel


class AxisModel(RigidModel):
    """Load `mass * ddq`.

    Attributes:
        mass: moved mass [kg].
        mass_known: False where the user gave none and 1 kg stands in until it is fitted.
    """

    joints = ("axis",)
    prismatic = (True,)

    @property
    def strongest(self) -> tuple[float, ...]:
        """No axis of any kind pushes harder than this [N]."""
        return (1e6,)

    def __init__(self, mass: float | None) -> None:
        self.mass_known = mass is not None
        self.mass = 1.0 if mass is None else float(mass)

    def load(self, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """Inertial force, (T, 1) [N]."""
        return self.mass * ddq

    def acceleration(self, q: np.ndarray, dq: np.ndarray, load: np.ndarray) -> np.ndarray:
        """Force over mass, (1,) [m/s^2]."""
        return load / self.mass

    def body_terms(self) -> list[BodyTerm]:
        """The mass, which the log itself measures better than a data sheet."""
        return [
            BodyTerm(
                name="mass",
                target="axis",
                recalibration=True,
                shape={},
                parameters=(Parameter(name="mass", unit="kg", lower=-self.mass),),
            )
        ]

    @property
    def payload(self) -> BodyTerm:
        """Mass on the mass; no term of its own, as the log cannot tell the two apart unless it changes."""
        return BodyTerm(
            name="payload",
            target="axis",
            recalibration=False,
            shape={},
            parameters=(Parameter(name="mass", unit="kg"),),
        )

    def body_columns(self, term: BodyTerm, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """Acceleration, (T, 1, 1)."""
        return ddq[:, :, None]

    def patched(self, term: BodyTerm, values: dict[str, float]) -> AxisModel:
        """The axis with its mass changed by `values["mass"]` [kg]."""
        out = AxisModel(self.mass + values["mass"])
        out.mass_known = self.mass_known
        return out

    def with_armature(self, joint: int, inertia: float) -> AxisModel:
        """The axis with `inertia` [kg] added."""
        return self.patched(self.body_terms()[0], {"mass": inertia})
