"""The effects of a model file on the dressing world's gown.

`delay` and `offset` act on recorded markers, which a world has none of: they are left out.
"""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import CaretreeError
from ...scene.gown import GownMesh
from ..effect import EffectError
from ..model_file import EffectEntry, EffectModel, load_model
from .cloth_effect import ClothSettings
from .proxy_bodies import ClothPatch

SPEC = {"mass": "mass", "elastic_stiffness": "elastic", "damping_stiffness": "damping", "bending_stiffness": "bending"}


def gown_effects(path: str | Path) -> EffectModel:
    """Read a model file for a gown.

    Raises:
        CaretreeError: it cannot be read, or is not for cloth.
    """
    try:
        model = load_model(path)
        model.require("cloth")
        for e in model.recalibration:
            if e.name not in SPEC or set(e.parameters) != {e.name} or e.parameters[e.name] <= 0:
                raise EffectError(f"recalibration of '{e.name}' does not fit a gown, it has {', '.join(SPEC)}")
    except EffectError as error:
        text = str(error)
        raise CaretreeError(f"--model {text if text.startswith(str(path)) else f'{path}: {text}'}") from None
    return model


def with_air(model: EffectModel | None, drag: float) -> EffectModel:
    """The effects with the air a gown file asks for, `drag` [N s^2/m^4], unless the model file has its own."""
    if model is None:
        model = EffectModel(system="cloth", base={}, recalibration=(), effects=())
    if any(e.name == "air_drag" for e in model.effects):
        return model
    air = EffectEntry(name="air_drag", target="cloth", parameters={"coefficient": drag})
    return dataclasses.replace(model, effects=(*model.effects, air))


def recalibrated(mesh: GownMesh, model: EffectModel) -> GownMesh:
    """The gown with its own numbers as the model file has them."""
    changes = {SPEC[e.name]: e.parameters[e.name] for e in model.recalibration}
    return dataclasses.replace(mesh, spec=dataclasses.replace(mesh.spec, **changes))


def gown_patch(
    model: EffectModel,
    mesh: GownMesh,
    start: np.ndarray,
    gravity: float,
    pinned: set[int],
    capsules: np.ndarray | None,
    per_second: float,
) -> ClothPatch:
    """The effects laid out on a gown.

    Args:
        model: checked model file.
        mesh: the gown.
        start: (V, 3) where it starts [m].
        gravity: [m/s^2].
        pinned: vertices that are held at the start.
        capsules: (K, 7) the person's trunk and limbs where cloth may cling, or None.
        per_second: the world's units of time in a second.
    """
    settings = ClothSettings(friction=mesh.spec.friction, gravity=(0.0, 0.0, -gravity))
    return ClothPatch(model.effects, start, mesh.faces, mesh.spec.mass, settings, pinned, capsules, per_second)


def loaded(mesh: GownMesh, patch: ClothPatch) -> GownMesh:
    """The gown as its soft body must be loaded: proxy bodies' mass taken off, friction changed.

    Raises:
        CaretreeError: the gown is lighter than its proxy bodies.
    """
    if patch.cloth_mass <= 0:
        raise CaretreeError(
            f"gown '{mesh.spec.name}' weighs {mesh.spec.mass * 1e3:.0f} g, to feel air or other forces "
            f"it must weigh more than {(mesh.spec.mass - patch.cloth_mass) * 1e3:.0f} g"
        )
    spec: Any = dataclasses.replace(mesh.spec, mass=patch.cloth_mass, friction=patch.settings.friction)
    return dataclasses.replace(mesh, spec=spec)
