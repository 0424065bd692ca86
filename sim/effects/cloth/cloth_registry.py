"""The effects that act on cloth, by name."""

from __future__ import annotations

from .added_mass import AddedMass
from .adhesion import Adhesion
from .air_drag import AirDrag
from .cloth_effect import ClothEffect
from .cloth_wind import ClothWind
from .contact_friction import ContactFriction
from .grip_slip import GripSlip
from .marker_reading import MarkerDelay, MarkerOffset
from .snag import Snag
from .strain_stiffening import StrainStiffening
from .tilted_gravity import TiltedGravity

CLOTH_EFFECTS: dict[str, ClothEffect] = {
    effect.name: effect
    for effect in (
        AirDrag(),
        ClothWind(),
        TiltedGravity(),
        AddedMass(),
        StrainStiffening(),
        ContactFriction(),
        Adhesion(),
        Snag(),
        GripSlip(),
        MarkerDelay(),
        MarkerOffset(),
    )
}
