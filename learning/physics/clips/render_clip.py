"""Render the depth clip of a gown that hangs by two vertices, one of which is let go.

The held vertices are the two ends of the neckline.  On the one that is let go sits a clamp of known mass: in free
fall alone a gown of twice the mass, stiffness, damping and drag moves exactly the same, so nothing but ratios
would show; against a known mass they all do (`docs/garment-physics.md`).

Two engines: `fast` moves the cloth with `mass_spring.py`, `bullet` with PyBullet (`bullet.py`); both start from the
same static equilibrium and agree where both can be exact (no air).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ....sim.errors import CaretreeError
from ....sim.scene.gown import GownSpec
from ..engine.fall import RATE, cut_of, fall, rest
from .camera import ClipCamera, misplacement, standard_camera
from .clip import Clip
from .depth_noise import disturb


def render_clip(
    spec: GownSpec, camera: ClipCamera | None = None, seed: int = 0, *, engine: str = "fast", disturbed: bool = False
) -> Clip:
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
        return clip_of(render_path(spec, path, named), named)
    rng = np.random.default_rng([seed, 5])
    return clip_of(disturb(render_path(spec, path, named.moved(misplacement(rng))), rng), named)


def path_of(spec: GownSpec, engine: str = "fast") -> np.ndarray:
    """(frames, V, 3) vertices of a gown that falls, at the instants of the frames [m].

    Raises:
        CaretreeError: the gown is too stiff to simulate, or the engine is unknown.
    """
    engines: dict[str, Callable[[GownSpec, np.ndarray], np.ndarray]] = {"fast": fall, "bullet": _bullet}
    if engine not in engines:
        raise CaretreeError(f"unknown engine '{engine}'; there are {', '.join(engines)}")
    return engines[engine](spec, rest(spec))


def render_path(spec: GownSpec, path: np.ndarray, camera: ClipCamera) -> np.ndarray:
    """Depth (frames, 64, 64) [m] of a gown along its path (frames, V, 3) [m], NaN where there is no gown."""
    mesh, _ = cut_of(spec)
    return np.array([camera.look(mesh, x) for x in path])


def clip_of(depth: np.ndarray, named: ClipCamera) -> Clip:
    """The clip of a depth (frames, 64, 64) whose camera is stated to be `named`.

    Raises:
        CaretreeError: a frame shows nothing of the gown.
    """
    return Clip(depth=depth, rate=RATE, intrinsics=named.intrinsics, pose_camera_in_map=named.pose_camera_in_map)


def _bullet(spec: GownSpec, start: np.ndarray) -> np.ndarray:
    from ..engine.bullet import bullet_fall  # pybullet is needed only here

    return bullet_fall(spec, start)
