"""The effects that act on a free body, by name."""

from __future__ import annotations

from .body_effect import BodyEffect
from .body_wind import BodyWind
from .buoyancy import Buoyancy
from .height_reading import HeightDelay, HeightGain, HeightOffset
from .linear_drag import LinearDrag
from .quadratic_drag import QuadraticDrag

BODY_EFFECTS: dict[str, BodyEffect] = {
    effect.name: effect
    for effect in (LinearDrag(), QuadraticDrag(), Buoyancy(), BodyWind(), HeightGain(), HeightOffset(), HeightDelay())
}
