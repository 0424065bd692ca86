"""Cloth that slides more or less easily over the body than the model says."""

from __future__ import annotations

import dataclasses

from ..effect import Parameter
from .cloth_effect import ClothEffect, ClothSettings


class ContactFriction(ClothEffect):
    """Friction coefficient raised by `change`."""

    name = "contact_friction"
    parameters = (Parameter(name="change", unit="1", lower=-2.0, upper=5.0),)
    sentence = "another friction between cloth and body"

    def settings(self, given: ClothSettings, values: dict[str, float]) -> ClothSettings:
        """The soft body's settings with friction changed."""
        return dataclasses.replace(given, friction=max(given.friction + values["change"], 0.0))
