"""The gown's fabric gives less or more than the model's."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ..effect import Parameter
from .dressing_effect import DressingEffect

if TYPE_CHECKING:
    from ...scene.scene import Scene

LEAST = 5.0  # that is left [N/m]


class FabricStretch(DressingEffect):
    """Stiffness of the fabric's springs."""

    name = "fabric_stretch"
    targets = ("gown",)
    parameters = (Parameter(name="elastic", unit="N/m", lower=-35.0, upper=30.0, typical=10.0),)
    on_cloth = True

    def scene(self, scene: Scene, values: dict[str, float]) -> Scene:
        """See `DressingEffect.scene`."""
        gown = replace(scene.gown, elastic=max(scene.gown.elastic + values["elastic"], LEAST))
        return replace(scene, gown=gown, mesh=replace(scene.mesh, spec=gown))
