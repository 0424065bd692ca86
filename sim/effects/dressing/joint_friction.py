"""The person's shoulders resist with more or less dry friction than the model's."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ..effect import Parameter
from .dressing_effect import DressingEffect

if TYPE_CHECKING:
    from ...scene.scene import Scene

LEAST = 0.05  # that is left [N m]


class JointFriction(DressingEffect):
    """Torque by which each axis of both shoulders resists before it moves."""

    name = "joint_friction"
    targets = ("shoulders",)
    parameters = (Parameter(name="torque", unit="N m", lower=-2.0, upper=10.0, typical=0.8),)

    def scene(self, scene: Scene, values: dict[str, float]) -> Scene:
        """See `DressingEffect.scene`."""
        person, more = scene.person, values["torque"]
        shoulder, elbow = person.dry_friction
        stiff = {
            side: replace(each, dry_friction=max(each.dry_friction + more, LEAST))
            for side, each in person.stiff.items()
        }
        friction = (max(shoulder + more, LEAST), elbow)
        return replace(scene, person=replace(person, dry_friction=friction, stiff=stiff))
