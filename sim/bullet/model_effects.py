"""What a model file of the gap workflow makes of a dressing scene before the room is built."""

from __future__ import annotations

from ..effects.cloth.gown_patch import gown_effects
from ..effects.dressing.dressing_model import changed_scene, changed_sensors
from ..effects.effect import EffectError
from ..effects.model_file import EffectModel, load_model
from ..errors import CaretreeError
from ..scene.scene import Scene
from ..sensors.sensor_changes import SensorChanges


def with_model(given: str | EffectModel, scene: Scene) -> tuple[EffectModel | None, Scene, SensorChanges | None]:
    """Effects on the gown, the scene as the model has it, and what it makes of the sensors.

    Args:
        given: the model, or its file.
        scene: what was drawn.

    Raises:
        CaretreeError: it cannot be read, or is for neither a gown nor a dressing.
    """
    try:
        model = given if isinstance(given, EffectModel) else load_model(given)
        if model.system != "dressing" and isinstance(given, str):
            return gown_effects(given), scene, None
        model.require("dressing")
        return None, changed_scene(scene, model), changed_sensors(model)
    except EffectError as error:
        raise CaretreeError(f"--model {error}") from None
