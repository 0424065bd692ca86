"""Effects on a free body: a force from its velocity, or a change of how its height is read."""

from __future__ import annotations

import abc
from typing import ClassVar

import numpy as np

from ..effect import Parameter, check_values


class BodyEffect(abc.ABC):
    """One effect on a body of 1 kg (specific force), so that a mass is not needed to fit it.

    With the mass known, force = mass * specific force, and the parameters scale with it.
    """

    name: ClassVar[str]
    parameters: ClassVar[tuple[Parameter, ...]]
    contains: ClassVar[frozenset[str]] = frozenset()
    per_mass: ClassVar[bool] = True  # the first parameter times the mass is the usual physical coefficient
    usual_unit: ClassVar[str] = ""  # its unit
    of_air: ClassVar[bool] = True  # the first parameter is a force of the air per mass: ballast makes it smaller
    sentence: ClassVar[str]

    @abc.abstractmethod
    def specific_force(self, velocity: np.ndarray, values: dict[str, float], gravity: float) -> np.ndarray:
        """Force per mass in the world frame, (..., 3) [m/s^2], z up."""

    def read(self, height: float, values: dict[str, float]) -> float:
        """How a height is recorded; effects on the sensor change this."""
        return height

    def ballasted(self, values: dict[str, float], factor: float) -> dict[str, float]:
        """Values for the same shape `factor` times as heavy: the air's forces stay, per mass they shrink."""
        first = self.parameters[0].name
        return {**values, first: values[first] / factor} if self.of_air else values

    def check(self, values: dict[str, float]) -> None:
        """Refuse values this effect cannot have.

        Raises:
            EffectError: a parameter is missing, unknown or outside its bounds.
        """
        check_values(self.name, values, self.parameters)
