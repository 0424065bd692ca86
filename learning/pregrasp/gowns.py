"""The gowns of the states: their cuts, and the cloth that was identified from clips of them, or another one.

A gown's key is the name of its cut, or `CUT/PHYSICS` where its cloth is not the identified one: `medium/true`,
`medium/tuned`, `medium/random 1234` (the number draws it).
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ...sim.errors import CaretreeError
from ...sim.scene.gown import GOWNS, HELD_OUT_GOWNS, GownMesh, GownSpec, build_gown
from ...sim.spring.sheet import Sheet
from ..physics.clips.parameters import NAMES, to_spec
from .numbers import HANG

# What was identified from one clip of each gown; `docs/garment-physics-results.md`, "The scene's gowns".
IDENTIFIED: dict[str, dict[str, float]] = {
    "medium": {"mass": 0.3641, "elastic": 37.35, "bending": 0.07449, "damping": 0.003353, "air_drag": 0.2626},
    "large": {"mass": 0.4832, "elastic": 44.96, "bending": 0.1003, "damping": 0.005067, "air_drag": 0.3357},
    "light": {"mass": 0.4003, "elastic": 39.72, "bending": 0.09765, "damping": 0.003526, "air_drag": 0.2975},
}
# What the paper's baseline 4 takes for the same clips (`learning/physics/networks/trivial_baselines.py`).
_USUAL = {"mass": 0.45, "elastic": 45.0, "bending": 0.1, "damping": 0.006, "air_drag": 0.3}
TUNED: dict[str, dict[str, float]] = {
    "medium": _USUAL,
    "large": _USUAL | {"elastic": 22.5, "bending": 0.05},
    "light": _USUAL,
}
TRUE_AIR_DRAG = 0.3  # of the air in which those clips were made [N s^2/m^4]; `GOWNS` leaves it out
STIFFEST = 120.0  # N/m for each kg of gown: `HANG.step` simulates all that was tried below 147, few above 200


def key_of(cut: str, physics: str, seed: int) -> str:
    """The key of a gown of that cut with cloth of `numbers.PHYSICS`; the seed draws a random one."""
    return cut if physics == "identified" else f"{cut}/{physics}" + (f" {seed}" if physics == "random" else "")


def gown_of(key: str) -> GownSpec:
    """A gown with its cloth; of a cut that is held out, what was identified and tuned is that of the medium gown.

    Args:
        key: `CUT` or `CUT/PHYSICS`, see above.

    Raises:
        CaretreeError: no such gown.
    """
    cuts = GOWNS | HELD_OUT_GOWNS
    name, _, physics = key.partition("/")
    if name not in cuts:
        raise CaretreeError(f"there is no gown '{name}', only {', '.join(cuts)}")
    kind, _, number = physics.partition(" ")
    if kind == "true":
        return replace(cuts[name], air_drag=TRUE_AIR_DRAG)
    if kind == "random":
        return _random_gown(np.random.default_rng([int(number), 22]), cuts[name])
    known = TUNED if kind == "tuned" else IDENTIFIED
    return replace(cuts[name], **known.get(name, known["medium"]))


def _random_gown(rng: np.random.Generator, cut: GownSpec) -> GownSpec:
    """A gown drawn from the whole range of what is identified, again where the springs' step is too long for it."""
    while True:
        drawn = to_spec(rng.random(len(NAMES)), cut)
        if drawn.elastic < STIFFEST * drawn.mass:
            return drawn


def draw_gown(rng: np.random.Generator) -> str:
    """The name of a gown that training may see."""
    return str(rng.choice(list(IDENTIFIED)))


@lru_cache(maxsize=8)
def mesh_of(key: str) -> GownMesh:
    """Rest shape of `gown_of`; kept."""
    return build_gown(gown_of(key))


@lru_cache(maxsize=8)
def sheet_of(key: str, deep: bool = False, air_drag: float | None = None) -> Sheet:
    """A sheet of that gown to be placed anew by whoever uses it next: sewing costs far more than a roll-out.

    Args:
        key: of the gown.
        deep: whether it meets itself.
        air_drag: instead of the gown's own [N s^2/m^4].
    """
    mesh = mesh_of(key)
    if air_drag is not None:
        mesh = replace(mesh, spec=replace(mesh.spec, air_drag=air_drag))
    return Sheet(mesh, mesh.vertices, HANG.step, meets_itself=deep)


def held_sheet(
    key: str, held: Collection[int], vertices: np.ndarray, deep: bool = False, air_drag: float | None = None
) -> Sheet:
    """That sheet at rest with its vertices (V, 3) [m] in their places, some of them held."""
    sheet = sheet_of(key, deep, air_drag)
    if sheet.held != set(held):
        sheet.held.clear()
        sheet.hold(held)
    sheet.place(vertices)
    sheet.forget_layers()
    return sheet
