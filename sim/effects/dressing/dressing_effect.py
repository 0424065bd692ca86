"""An effect on the dressing world as a whole: it changes the scene that is drawn, or what sensors say."""

from __future__ import annotations

import abc
from typing import TYPE_CHECKING, ClassVar

from ..effect import EffectError, Parameter, check_values

if TYPE_CHECKING:
    from ...scene.scene import Scene
    from ...sensors.sensor_changes import SensorChanges


class DressingEffect(abc.ABC):
    """One effect.  Its numbers are added to the model's own, so that 0 is the model as it is."""

    name: ClassVar[str]
    targets: ClassVar[tuple[str, ...]]
    parameters: ClassVar[tuple[Parameter, ...]]
    on_cloth: ClassVar[bool] = False  # shows only where a hand holds the gown

    def scene(self, scene: Scene, values: dict[str, float]) -> Scene:
        """The scene with the effect."""
        return scene

    def sensors(self, sensors: SensorChanges, target: str, values: dict[str, float]) -> SensorChanges:
        """The sensors with the effect."""
        return sensors

    def check(self, target: str, values: dict[str, float]) -> None:
        """Refuse what this effect cannot have.

        Raises:
            EffectError: another target, or values outside the bounds.
        """
        if target not in self.targets:
            raise EffectError(f"effect {self.name} acts on {' or '.join(self.targets)}, not on '{target}'")
        check_values(self.name, values, self.parameters)
