"""The effects that act on a dressing run, by name, and what a model file makes of a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .arm_weight import ArmWeight
from .dressing_effect import DressingEffect
from .fabric_stretch import FabricStretch
from .joint_damping import JointDamping
from .joint_friction import JointFriction
from .joint_stiffness import JointStiffness
from .load_cell_bias import LoadCellBias
from .sleeve_friction import SleeveFriction

if TYPE_CHECKING:
    from ...scene.scene import Scene
    from ..model_file import EffectModel

DRESSING_EFFECTS: dict[str, DressingEffect] = {
    effect.name: effect
    for effect in (
        ArmWeight(),
        JointFriction(),
        JointDamping(),
        JointStiffness(),
        SleeveFriction(),
        FabricStretch(),
        LoadCellBias(),
    )
}


def changed_scene(scene: Scene, model: EffectModel) -> Scene:
    """A scene with the effects of a checked model file for dressing."""
    for entry in (*model.recalibration, *model.effects):
        scene = DRESSING_EFFECTS[entry.name].scene(scene, entry.parameters)
    return scene


def load_cell_bias(model: EffectModel) -> np.ndarray:
    """(2, 3) what the sensors of both hands add along the hands' axes under such a file [N]."""
    entries = (*model.recalibration, *model.effects)
    return sum((DRESSING_EFFECTS[e.name].bias(e.target, e.parameters) for e in entries), np.zeros((2, 3)))
