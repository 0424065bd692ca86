"""The fall of a released gown: rest shape, time step and path, by the mass-spring engine."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ....sim.errors import CaretreeError
from ....sim.scene.gown import GownMesh, GownSpec, build_gown
from ....sim.spring.mass_spring import Springs, Weave, advance, damped, weave
from .equilibrium import held_start, static_equilibrium

FRAMES = 15
RATE = 30.0  # [Hz]
CLAMP_MASS = 0.03  # of the clamp that falls with the released vertex [kg]
STIFFNESS_MAX = 0.35  # elastic * dt^2 / vertex mass: half of what is stable; the step is chosen to keep below it
STEPS_MAX = 400  # between two frames: beyond it a gown is not simulated but refused


@lru_cache(maxsize=8)
def _cut(
    front: int, back: int, hole: tuple[int, int], strap: int, length: int, sleeve: int, spacing: float
) -> tuple[GownMesh, Weave]:
    mesh = build_gown(
        GownSpec(
            name="cut", front=front, back=back, hole=hole, strap=strap, length=length, sleeve=sleeve, spacing=spacing
        )
    )
    return mesh, weave(mesh)


def cut_of(spec: GownSpec) -> tuple[GownMesh, Weave]:
    """Mesh and weave of a gown's cut (the mesh's own spec is not this one's); kept between calls."""
    return _cut(spec.front, spec.back, tuple(spec.hole), spec.strap, spec.length, spec.sleeve, spec.spacing)


def steps_per_frame(spec: GownSpec, vertices: int) -> int:
    """Physics steps between two frames, by the stability rule of explicit springs.

    Raises:
        CaretreeError: the gown is too stiff or too light to be simulated.
    """
    longest = np.sqrt(STIFFNESS_MAX * spec.mass / vertices / spec.elastic)
    steps = int(np.ceil(1.0 / RATE / longest))
    if steps > STEPS_MAX:
        raise CaretreeError(
            f"gown '{spec.name}': elastic {spec.elastic:g} N/m at {spec.mass:g} kg needs steps of "
            f"{longest * 1e3:.3f} ms, at least {1e3 / RATE / STEPS_MAX:.3f} ms are allowed"
        )
    return steps


def springs_of(spec: GownSpec, woven: Weave) -> Springs:
    """The springs of a gown."""
    return woven.springs(
        mass=spec.mass, elastic=spec.elastic, bending=spec.bending, damping=spec.damping, air_drag=spec.air_drag
    )


def rest(spec: GownSpec) -> np.ndarray:
    """(V, 3) how a gown hangs by the ends of its neckline [m]; the origin is midway between them."""
    mesh, woven = cut_of(spec)
    return static_equilibrium(springs_of(spec, woven), held_start(mesh, mesh.corners), mesh.corners)


def fall(spec: GownSpec, start: np.ndarray, frames: int = FRAMES, clamp: float = CLAMP_MASS) -> np.ndarray:
    """(frames, V, 3) vertices at the instants of the frames, from `start` (V, 3) with one vertex let go [m].

    Args:
        spec: the gown.
        start: where it hangs.
        frames: how many.
        clamp: mass on the released vertex [kg].
    """
    mesh, woven = cut_of(spec)
    springs = springs_of(spec, woven)
    springs.mass[mesh.corners[1]] += clamp
    free = np.ones(len(start), bool)
    free[mesh.corners[0]] = False
    steps = steps_per_frame(spec, len(start))
    x, v = start.copy(), np.zeros_like(start)
    system = damped(springs, free, 1.0 / RATE / steps)
    out = [x.copy()]
    for _ in range(frames - 1):
        advance(springs, x, v, free, 1.0 / RATE / steps, steps, system)
        out.append(x.copy())
    return np.array(out)
