"""The effects that act on one joint, by name."""

from __future__ import annotations

from ..effect import JointEffect
from .armature import Armature
from .asymmetric_friction import AsymmetricFriction
from .backlash import Backlash
from .contact import Contact
from .coulomb_friction import CoulombFriction
from .delay import Delay
from .gain_error import GainError
from .load_friction import LoadFriction
from .offset import Offset
from .spring import Spring
from .stribeck_friction import StribeckFriction
from .viscous_friction import ViscousFriction

JOINT_EFFECTS: dict[str, JointEffect] = {
    effect.name: effect
    for effect in (
        ViscousFriction(),
        CoulombFriction(),
        AsymmetricFriction(),
        StribeckFriction(),
        LoadFriction(),
        Offset(),
        GainError(),
        Delay(),
        Backlash(),
        Armature(),
        Spring(),
        Contact(),
    )
}
