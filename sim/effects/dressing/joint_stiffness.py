"""The person's shoulders draw their arms back to where they lay."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ..effect import Parameter
from .dressing_effect import DressingEffect

if TYPE_CHECKING:
    from ...scene.scene import Scene


class JointStiffness(DressingEffect):
    """Torque per angle of abduction and elevation, of both shoulders, from where the arm lay at the start."""

    name = "joint_stiffness"
    targets = ("shoulders",)
    parameters = (Parameter(name="stiffness", unit="N m/rad", lower=0.0, upper=30.0, typical=2.0),)

    def scene(self, scene: Scene, values: dict[str, float]) -> Scene:
        """See `DressingEffect.scene`."""
        spring = scene.person.shoulder_spring + values["stiffness"]
        return replace(scene, person=replace(scene.person, shoulder_spring=spring))
