"""The joints of the person's arms resist speed more or less than the model's."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ..effect import Parameter
from .dressing_effect import DressingEffect

if TYPE_CHECKING:
    from ...scene.scene import Scene

LEAST = 0.05  # that is left [N m s/rad]


class JointDamping(DressingEffect):
    """Torque per speed of every joint of both arms."""

    name = "joint_damping"
    targets = ("arms",)
    parameters = (Parameter(name="damping", unit="N m s/rad", lower=-4.0, upper=40.0, typical=3.0),)

    def scene(self, scene: Scene, values: dict[str, float]) -> Scene:
        """See `DressingEffect.scene`."""
        viscous = max(scene.person.viscous + values["damping"], LEAST)
        return replace(scene, person=replace(scene.person, viscous=viscous))
