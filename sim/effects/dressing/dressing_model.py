"""What a model file for dressing makes of a scene and of the robot's sensors."""

from __future__ import annotations

from ...scene.scene import Scene
from ...sensors.sensor_changes import SensorChanges
from ..model_file import EffectModel
from .dressing_registry import DRESSING_EFFECTS


def changed_scene(scene: Scene, model: EffectModel) -> Scene:
    """A scene with the effects of a checked model file for dressing."""
    for entry in (*model.recalibration, *model.effects):
        scene = DRESSING_EFFECTS[entry.name].scene(scene, entry.parameters)
    return scene


def changed_sensors(model: EffectModel) -> SensorChanges:
    """What such a file makes of the sensors."""
    sensors = SensorChanges()
    for entry in (*model.recalibration, *model.effects):
        sensors = DRESSING_EFFECTS[entry.name].sensors(sensors, entry.target, entry.parameters)
    return sensors
