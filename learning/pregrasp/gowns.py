"""The gowns of the states: their cuts, and the cloth that was identified from clips of them."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ...sim.errors import CaretreeError
from ...sim.scene.gown import GOWNS, HELD_OUT_GOWNS, GownMesh, GownSpec, build_gown
from ...sim.spring.sheet import Sheet
from .numbers import HANG

# What was identified from one clip of each gown; `docs/garment-physics-results.md`, "The scene's gowns".
IDENTIFIED: dict[str, dict[str, float]] = {
    "medium": {"mass": 0.3641, "elastic": 37.35, "bending": 0.07449, "damping": 0.003353, "air_drag": 0.2626},
    "large": {"mass": 0.4832, "elastic": 44.96, "bending": 0.1003, "damping": 0.005067, "air_drag": 0.3357},
    "light": {"mass": 0.4003, "elastic": 39.72, "bending": 0.09765, "damping": 0.003526, "air_drag": 0.2975},
}


def gown_of(name: str) -> GownSpec:
    """A gown with the physics that was identified of it; a cut that is held out has that of the medium gown.

    Raises:
        CaretreeError: no such gown.
    """
    cuts = GOWNS | HELD_OUT_GOWNS
    if name not in cuts:
        raise CaretreeError(f"there is no gown '{name}', only {', '.join(cuts)}")
    return replace(cuts[name], **IDENTIFIED.get(name, IDENTIFIED["medium"]))


def draw_gown(rng: np.random.Generator) -> str:
    """The name of a gown that training may see."""
    return str(rng.choice(list(IDENTIFIED)))


@lru_cache(maxsize=8)
def mesh_of(name: str) -> GownMesh:
    """Rest shape of `gown_of`; kept."""
    return build_gown(gown_of(name))


@lru_cache(maxsize=8)
def sheet_of(name: str, deep: bool = False, air_drag: float | None = None) -> Sheet:
    """A sheet of that gown to be placed anew by whoever uses it next: sewing costs far more than a roll-out.

    Args:
        name: of the gown.
        deep: whether it meets itself.
        air_drag: instead of the gown's own [N s^2/m^4].
    """
    mesh = mesh_of(name)
    if air_drag is not None:
        mesh = replace(mesh, spec=replace(mesh.spec, air_drag=air_drag))
    return Sheet(mesh, mesh.vertices, HANG.step, meets_itself=deep)


def held_sheet(
    name: str, held: Collection[int], vertices: np.ndarray, deep: bool = False, air_drag: float | None = None
) -> Sheet:
    """That sheet at rest with its vertices (V, 3) [m] in their places, some of them held."""
    sheet = sheet_of(name, deep, air_drag)
    if sheet.held != set(held):
        sheet.held.clear()
        sheet.hold(held)
    sheet.place(vertices)
    sheet.forget_layers()
    return sheet
