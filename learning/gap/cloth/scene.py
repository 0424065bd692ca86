"""What a cloth measurement set says: mesh, physics, pins, capsules, markers, and what was measured."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from ....sim.bullet.soft_world import GRAVITY, STABILITY_MAX
from ....sim.effects.cloth.proxy_bodies import PROXY_MASS, proxy_count
from ....sim.obj_file import read_obj
from ..errors import GapError
from ..measurement import Episode, MeasurementSet, require_columns
from ..table import read_table

DEFAULTS = {
    "mass": 0.25,
    "elastic_stiffness": 40.0,
    "damping_stiffness": 0.005,
    "bending_stiffness": 0.1,
    "friction": 0.4,
}
FINEST = 2e-5  # [s]; a finer time step than this is no simulation any more
FAR = 10.0  # [m] a marker may move beyond the mesh's own size


@dataclass(frozen=True, kw_only=True)
class Physics:
    """Parameters of the soft body, SI.

    per_second: units of time in a second of the world that is simulated; 1 is plain SI.  A solver's tolerances are in
    its own units, so a recording from a world with another unit is predicted in that unit.
    """

    mass: float
    elastic_stiffness: float
    damping_stiffness: float
    bending_stiffness: float
    friction: float
    gravity: tuple[float, float, float]
    time_step: float
    per_second: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Pin:
    """Vertices held together.

    Attributes:
        vertices: ids.
        release_t: when they are let go [s]; inf for never.
        path: (K, 4) time and displacement from the start pose [s, m], or None where they stay.
    """

    vertices: tuple[int, ...]
    release_t: float
    path: np.ndarray | None


@dataclass(frozen=True, kw_only=True)
class ClothScene:
    """Everything but the episode.

    Attributes:
        vertices: (V, 3) start pose [m].
        faces: (F, 3) of the cloth.
        stays: (S, 3) triangles that are springs alone.
        physics: of the soft body.
        capsules: (K, 7) a, b, radius [m].
        markers: vertex ids.
    """

    vertices: np.ndarray
    faces: np.ndarray
    physics: Physics
    capsules: np.ndarray
    markers: tuple[int, ...]
    stays: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), dtype=int))

    @property
    def sewn(self) -> np.ndarray:
        """(F + S, 3) all triangles whose edges are springs."""
        return np.vstack([self.faces, self.stays])


@dataclass(frozen=True, kw_only=True)
class ClothEpisode:
    """One recording.

    Attributes:
        name, role: as listed.
        t: (T,) from the start pose [s].
        markers: (T, M, 3) [m].
        load: (T, 3) at the first pin [N], or None.
        pins: in this episode.
    """

    name: str
    role: str
    t: np.ndarray
    markers: np.ndarray
    load: np.ndarray | None
    pins: tuple[Pin, ...]


def read_scene(measured: MeasurementSet) -> tuple[ClothScene, list[ClothEpisode]]:
    """The scene and its episodes.

    Raises:
        GapError: something is missing or does not fit; one sentence with file, column and row.
    """
    file, s = measured.folder / "measurement.yaml", measured.settings
    if not isinstance(s.get("mesh"), str):
        raise GapError(f"{file}: `mesh` is {s.get('mesh')!r}, the path of an OBJ file is needed")
    vertices, faces, stays = read_obj(measured.folder / s["mesh"])
    ids = s.get("markers")
    if not isinstance(ids, list) or not ids or not all(isinstance(i, int) and 0 <= i < len(vertices) for i in ids):
        raise GapError(f"{file}: `markers` must list vertex ids from 0 to {len(vertices) - 1}")
    scene = ClothScene(
        vertices=vertices,
        faces=faces,
        stays=stays,
        physics=_physics(file, s.get("physics") or {}, len(vertices)),
        capsules=_capsules(file, s.get("capsules") or []),
        markers=tuple(ids),
    )
    episodes = [
        _episode(e, scene, _pins(file, e.settings.get("pins", s.get("pins")), scene)) for e in measured.episodes
    ]
    if any(e.load is None for e in episodes):  # a load can only be compared where every recording has one
        episodes = [replace(e, load=None) for e in episodes]
    return scene, episodes


def _physics(file: Path, given: Any, count: int) -> Physics:
    if not isinstance(given, dict):
        raise GapError(f"{file}: `physics` is {given!r}, names with numbers are needed (mass, elastic_stiffness, ...)")
    values = {key: _positive(file, key, given.get(key, default)) for key, default in DEFAULTS.items()}
    least = 1.5 * PROXY_MASS * proxy_count(count)
    if values["mass"] < least:
        raise GapError(
            f"{file}: physics.mass is {values['mass']:g} kg, effects act through proxy bodies of "
            f"{least / 1.5:g} kg together, so a cloth of {count} vertices must weigh at least {least:g} kg"
        )
    return Physics(
        **values,
        gravity=_gravity(file, given.get("gravity", -GRAVITY)),
        time_step=_time_step(file, given.get("time_step", 0.002), values, count),
        per_second=_per_second(file, given.get("per_second", 1.0)),
    )


def _positive(file: Path, key: str, x: Any) -> float:
    """A finite number that is not negative; a mass may not be 0 either."""
    if not _finite(x) or x < 0 or (key == "mass" and x == 0):
        raise GapError(f"{file}: physics.{key} is {x!r}, a positive number is needed")
    return float(x)


def _gravity(file: Path, g: Any) -> tuple[float, float, float]:
    """Acceleration (3,) [m/s^2]; one number points down."""
    g = (0.0, 0.0, -abs(g)) if isinstance(g, int | float) else g
    if not isinstance(g, list | tuple) or len(g) != 3 or not all(_finite(x) for x in g):
        raise GapError(f"{file}: physics.gravity is {g!r}, a number or three numbers [m/s^2] are needed")
    return float(g[0]), float(g[1]), float(g[2])


def _time_step(file: Path, step: Any, values: dict[str, float], count: int) -> float:
    """The step asked for, halved until springs between `count` vertices are stable [s]."""
    if not _finite(step) or not 1e-5 <= step <= 0.02:
        raise GapError(f"{file}: physics.time_step is {step!r}, a number from 0.00001 to 0.02 [s] is needed")
    limit = float(np.sqrt(STABILITY_MAX * values["mass"] / count / max(values["elastic_stiffness"], 1e-9)))
    if limit < FINEST:
        raise GapError(
            f"{file}: physics.elastic_stiffness is {values['elastic_stiffness']:g} at a mass of {values['mass']:g} kg "
            f"over {count} vertices, springs this stiff need steps of {limit:.1g} s, {FINEST:g} s is the finest"
        )
    while step > limit:  # explicit springs explode above this
        step /= 2.0
    return float(step)


def _per_second(file: Path, unit: Any) -> float:
    if isinstance(unit, bool) or not isinstance(unit, int | float) or not 1.0 <= unit <= 1e6:
        raise GapError(f"{file}: physics.per_second is {unit!r}, a number from 1 to 1000000 is needed")
    return float(unit)


def _finite(x: Any) -> bool:
    return isinstance(x, int | float) and not isinstance(x, bool) and bool(np.isfinite(x))


def _capsules(file: Path, listed: Any) -> np.ndarray:
    try:
        rows = [[*map(float, c["a"]), *map(float, c["b"]), float(c["radius"])] for c in listed]
        table = np.array(rows, dtype=float).reshape(-1, 7)
    except (KeyError, TypeError, ValueError):
        table = np.full((1, 7), np.nan)
    if not np.isfinite(table).all() or (table[:, 6] <= 0).any():
        raise GapError(f"{file}: every capsule needs a, b (three numbers each) and a positive radius [m]")
    return table


def _pins(file: Path, listed: Any, scene: ClothScene) -> tuple[Pin, ...]:
    if listed is None:
        return ()
    listed = [listed] if isinstance(listed, dict) else listed
    if not isinstance(listed, list):
        raise GapError(f"{file}: `pins` is {listed!r}, a list of entries with `vertices` is needed")
    if listed and all(isinstance(i, int) for i in listed):
        listed = [{"vertices": listed}]
    return tuple(_pin(file, p, len(scene.vertices)) for p in listed)


def _pin(file: Path, given: Any, count: int) -> Pin:
    """One entry of `pins` for a cloth of `count` vertices."""
    ids = given.get("vertices") if isinstance(given, dict) else None
    ids = [ids] if isinstance(ids, int) else ids
    if not isinstance(ids, list) or not all(isinstance(i, int) and 0 <= i < count for i in ids):
        raise GapError(f"{file}: every pin needs `vertices`, ids from 0 to {count - 1}, this one has {ids!r}")
    path = given.get("path")
    if path is not None and not isinstance(path, str):
        raise GapError(f"{file}: path of a pin is {path!r}, the name of a CSV with t, x, y, z is needed")
    release = given.get("release_t")
    displacement = _displacement(file.parent / path) if path else None
    if release is not None and not _finite(release):
        raise GapError(f"{file}: release_t of a pin is {release!r}, a time in seconds is needed")
    return Pin(vertices=tuple(ids), release_t=float("inf") if release is None else float(release), path=displacement)


def _displacement(file: Path) -> np.ndarray:
    """(K, 4) time and displacement [s, m], whether the file gives places or displacements."""
    table = read_table(file)
    for axis in "xyz":
        if axis not in table:
            raise GapError(f"{file}: column '{axis}' is missing (row 1 has {', '.join(table)})")
    path = np.stack([table[c] for c in ("t", "x", "y", "z")], axis=1)
    path[:, 1:] -= path[0, 1:]
    return path


def _episode(e: Episode, scene: ClothScene, pins: tuple[Pin, ...]) -> ClothEpisode:
    names = [f"m{k}{a}" for k in range(len(scene.markers)) for a in "xyz"]
    require_columns(e, names)
    step = float(np.median(np.diff(e.t)))
    if step > 0.5:
        raise GapError(f"{e.file}: column 't' steps by {step:g}, it must be in seconds (row 3)")
    size = float(np.ptp(scene.vertices, axis=0).max())
    for name, place in zip(names, scene.vertices[list(scene.markers)].ravel(), strict=True):
        row = int(np.argmax(np.abs(e.columns[name] - place)))
        if abs(e.columns[name][row] - place) > FAR + 2.0 * size:
            raise GapError(
                f"{e.file}: column '{name}', row {row + 2} is {e.columns[name][row]:g}, markers must be in metres in "
                "the mesh's frame"
            )
    markers = np.stack([e.columns[n] for n in names], axis=1).reshape(len(e.t), -1, 3)
    first = markers[0] - scene.vertices[list(scene.markers)]
    k = int(np.argmax(np.abs(first).max(axis=1)))
    if np.abs(first[k]).max() > 1.0 + 2.0 * np.ptp(scene.vertices, axis=0).max():
        raise GapError(
            f"{e.file}: column 'm{k}x', row 2 lies {np.abs(first[k]).max():.3g} m from its vertex "
            f"{scene.markers[k]}, markers must be in metres in the mesh's frame"
        )
    load = (
        np.stack([e.columns[c] for c in ("fx", "fy", "fz")], axis=1)
        if all(c in e.columns for c in ("fx", "fy", "fz"))
        else None
    )
    return ClothEpisode(
        name=e.name, role=e.role, t=e.t - min(0.0, float(e.t[0])), markers=markers, load=load, pins=pins
    )
