"""What a model file for dressing makes of a scene and of the hands' force sensors."""

from __future__ import annotations

import numpy as np

from ...scene.scene import Scene
from ..model_file import EffectModel
from .dressing_registry import DRESSING_EFFECTS


def changed_scene(scene: Scene, model: EffectModel) -> Scene:
    """A scene with the effects of a checked model file for dressing."""
    for entry in (*model.recalibration, *model.effects):
        scene = DRESSING_EFFECTS[entry.name].scene(scene, entry.parameters)
    return scene


def load_cell_bias(model: EffectModel) -> np.ndarray:
    """(2, 3) what the sensors of both hands add along the hands' axes under such a file [N]."""
    entries = (*model.recalibration, *model.effects)
    return sum((DRESSING_EFFECTS[e.name].bias(e.target, e.parameters) for e in entries), np.zeros((2, 3)))
