"""The gown slides over the skin harder or more easily than the model's."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ..effect import Parameter
from .dressing_effect import DressingEffect

if TYPE_CHECKING:
    from ...scene.scene import Scene

LEAST = 0.01  # coefficient that is left


class SleeveFriction(DressingEffect):
    """Coefficient of Coulomb friction between gown and skin."""

    name = "sleeve_friction"
    targets = ("gown",)
    parameters = (Parameter(name="coefficient", unit="1", lower=-0.15, upper=1.0, typical=0.1),)
    on_cloth = True

    def scene(self, scene: Scene, values: dict[str, float]) -> Scene:
        """See `DressingEffect.scene`."""
        cloth = scene.gown.friction  # Bullet multiplies both
        coefficient = max(scene.person.skin_friction * cloth + values["coefficient"], LEAST)
        return replace(scene, person=replace(scene.person, skin_friction=coefficient / cloth))
