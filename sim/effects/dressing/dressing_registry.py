"""The effects that act on a dressing run, by name."""

from __future__ import annotations

from .arm_weight import ArmWeight
from .camera_offset import CameraOffset
from .dressing_effect import DressingEffect
from .fabric_stretch import FabricStretch
from .joint_damping import JointDamping
from .joint_friction import JointFriction
from .joint_stiffness import JointStiffness
from .load_cell_bias import LoadCellBias
from .load_delay import LoadDelay
from .sleeve_friction import SleeveFriction

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
        LoadDelay(),
        CameraOffset(),
    )
}
