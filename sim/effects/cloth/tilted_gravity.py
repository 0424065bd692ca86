"""Gravity that is not along -z: a scene or camera frame that is not level."""

from __future__ import annotations

import dataclasses

import numpy as np

from ..effect import Parameter
from .cloth_effect import ClothEffect, ClothSettings


class TiltedGravity(ClothEffect):
    """Gravity turned by small angles about y (towards x) and about x (towards y), its size kept."""

    name = "tilted_gravity"
    parameters = (
        Parameter(name="towards_x", unit="rad", lower=-1.0, upper=1.0),
        Parameter(name="towards_y", unit="rad", lower=-1.0, upper=1.0),
    )
    sentence = "gravity that is not along -z"

    def settings(self, given: ClothSettings, values: dict[str, float]) -> ClothSettings:
        """The soft body's settings with gravity turned."""
        size = float(np.linalg.norm(given.gravity))
        direction = np.array(given.gravity) / max(size, 1e-12)
        direction = direction + np.array([np.tan(values["towards_x"]), np.tan(values["towards_y"]), 0.0])
        turned = size * direction / np.linalg.norm(direction)
        return dataclasses.replace(given, gravity=tuple(float(g) for g in turned))
