"""Film a gown that hangs by two vertices, one of which is let go.

The held vertices are the two ends of the neckline.  On the one that is let go sits a clamp of known mass: in free
fall alone a gown of twice the mass, stiffness, damping and drag moves exactly the same, so nothing but ratios
would show; against a known mass they all do (`docs/garment-physics.md`).

Two engines: `fast` moves the cloth with `springs.py`, `bullet` with PyBullet (`bullet_fall.py`); both start from the
same static hang and agree where both can be exact (no air).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from ...sim.errors import CaretreeError
from ...sim.gown import GownMesh, GownSpec, build_gown
from .clip import FRAMES, RATE, Clip
from .film_camera import FilmCamera, misplacement, standard_camera
from .hang import hang, held_start
from .noise import disturb
from .springs import Springs, Weave, advance, damped, weave

CLAMP_MASS = 0.03  # of the clamp that falls with the released vertex [kg]
STIFFNESS_MAX = 0.35  # elastic * dt^2 / vertex mass: half of what is stable; the step is chosen to keep below it
STEPS_MAX = 400  # between two frames: beyond it a gown is not simulated but refused


@lru_cache(maxsize=8)
def _cut(front: int, back: int, hole: tuple[int, int], strap: int, length: int, sleeve: int,
         spacing: float) -> tuple[GownMesh, Weave]:
    mesh = build_gown(GownSpec(name="cut", front=front, back=back, hole=hole, strap=strap, length=length,
                               sleeve=sleeve, spacing=spacing))
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
        raise CaretreeError(f"gown '{spec.name}': elastic {spec.elastic:g} N/m at {spec.mass:g} kg needs steps of "
                            f"{longest * 1e3:.3f} ms, at least {1e3 / RATE / STEPS_MAX:.3f} ms are allowed")
    return steps


def springs_of(spec: GownSpec, woven: Weave) -> Springs:
    """The springs of a gown."""
    return woven.springs(mass=spec.mass, elastic=spec.elastic, bending=spec.bending, damping=spec.damping,
                         air_drag=spec.air_drag)


def rest(spec: GownSpec) -> np.ndarray:
    """(V, 3) how a gown hangs by the ends of its neckline [m]; the origin is midway between them."""
    mesh, woven = cut_of(spec)
    return hang(springs_of(spec, woven), held_start(mesh, mesh.corners), mesh.corners)


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


def film(spec: GownSpec, camera: FilmCamera | None = None, seed: int = 0, *, engine: str = "fast",
         disturbed: bool = False) -> Clip:
    """A depth clip of a gown falling.  The same arguments give the same clip.

    Args:
        spec: cut and cloth of the gown.
        camera: where it is seen from; `standard_camera()` when omitted.
        seed: of the camera's noise.
        engine: `fast` or `bullet`.
        disturbed: with noise, holes, lost edges, and the camera not quite where the clip says it is.

    Raises:
        CaretreeError: the gown is too stiff to simulate, leaves the picture, or the engine is unknown.
    """
    named = camera or standard_camera()
    path = path_of(spec, engine)
    if not disturbed:
        return clip_of(seen(spec, path, named), named)
    rng = np.random.default_rng([seed, 5])
    return clip_of(disturb(seen(spec, path, named.moved(misplacement(rng))), rng), named)


def path_of(spec: GownSpec, engine: str = "fast") -> np.ndarray:
    """(frames, V, 3) vertices of a gown that falls, at the instants of the frames [m].

    Raises:
        CaretreeError: the gown is too stiff to simulate, or the engine is unknown.
    """
    engines: dict[str, Callable[[GownSpec, np.ndarray], np.ndarray]] = {"fast": fall, "bullet": _bullet}
    if engine not in engines:
        raise CaretreeError(f"unknown engine '{engine}'; there are {', '.join(engines)}")
    return engines[engine](spec, rest(spec))


def seen(spec: GownSpec, path: np.ndarray, camera: FilmCamera) -> np.ndarray:
    """(frames, 64, 64) depth of a gown's path (frames, V, 3) [m], NaN where there is no gown."""
    mesh, _ = cut_of(spec)
    return np.array([camera.look(mesh, x) for x in path])


def clip_of(depth: np.ndarray, named: FilmCamera) -> Clip:
    """The clip of a depth (frames, 64, 64) whose camera is said to be `named`.

    Raises:
        CaretreeError: a frame shows nothing of the gown.
    """
    return Clip(depth=depth, rate=RATE, intrinsics=named.intrinsics, pose_camera_in_map=named.pose_camera_in_map)


def _bullet(spec: GownSpec, start: np.ndarray) -> np.ndarray:
    from .bullet_fall import bullet_fall  # pybullet is needed only here

    return bullet_fall(spec, start)
