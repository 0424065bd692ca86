"""The person's arms are heavier or lighter than the model's."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ..effect import Parameter
from .dressing_effect import DressingEffect

if TYPE_CHECKING:
    from ...scene.scene import Scene

LEAST = 0.2  # of an arm that is left [kg]


class ArmWeight(DressingEffect):
    """Mass of each arm, in the shares that its segments have."""

    name = "arm_weight"
    targets = ("arms",)
    parameters = (Parameter(name="mass", unit="kg", lower=-0.6, upper=5.0, typical=0.2),)

    def scene(self, scene: Scene, values: dict[str, float]) -> Scene:
        """See `DressingEffect.scene`."""
        person = scene.person
        added = max(person.arm_mass_added + values["mass"], LEAST - person.arm_mass)
        return replace(scene, person=replace(person, arm_mass_added=added))
