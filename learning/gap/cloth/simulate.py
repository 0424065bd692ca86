"""Run one cloth episode in PyBullet and read it as the sensors would; results are kept on disk."""

from __future__ import annotations

import hashlib
import multiprocessing
import time
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np

from ....sim.bullet.soft_world import SoftWorld
from ....sim.effects.cloth.cloth_effect import ClothSettings
from ....sim.effects.cloth.cloth_registry import CLOTH_EFFECTS
from ....sim.effects.cloth.proxy_bodies import ClothPatch
from ....sim.effects.model_file import EffectEntry
from .scene import ClothEpisode, ClothScene, Pin

HAND = 0.2  # mass of the body that drags a pin along [kg]
PULL = 200.0  # most that may drag it [N]


class Simulator:
    """Runs episodes of one scene; the same run is never done twice where a cache folder is given.

    Attributes:
        runs: simulations really done.
        seconds: time they took.
    """

    def __init__(self, scene: ClothScene, cache: Path | None = None, jobs: int = 1) -> None:
        self.scene, self.cache, self.runs, self.seconds = scene, cache, 0, 0.0
        self.jobs = jobs
        self._kept: dict[str, np.ndarray] = {}
        if cache is not None:
            cache.mkdir(parents=True, exist_ok=True)

    def run(
        self,
        episode: ClothEpisode,
        effects: tuple[EffectEntry, ...] = (),
        physics: dict[str, float] | None = None,
    ) -> np.ndarray:
        """Markers and, where it was measured, load at the episode's times: (T, 3 M) or (T, 3 M + 3)."""
        acting, reading = canonical(effects)
        key = self._key(episode, acting, physics or {})
        if key not in self._kept:
            file = self._file(key)
            if file is not None and file.is_file():
                self._kept[key] = np.load(file)
            else:
                started = time.monotonic()
                self._keep(key, dense(self.scene, episode, acting, physics or {}))
                self.seconds += time.monotonic() - started
        return recorded(episode, self._kept[key], reading)

    def ahead(self, wanted: list[tuple[ClothEpisode, tuple[EffectEntry, ...], dict[str, float]]]) -> None:
        """Run what will be asked for, in parallel over `jobs` processes; results already there are not done again."""
        missing = {}
        for episode, effects, physics in wanted:
            acting = canonical(effects)[0]
            key = self._key(episode, acting, physics)
            file = self._file(key)
            if key not in self._kept and not (file is not None and file.is_file()):
                missing[key] = (self.scene, episode, acting, physics)
        if self.jobs < 2 or len(missing) < 2:
            return
        started = time.monotonic()
        # fork would copy a loaded physics engine with its threads
        with ProcessPoolExecutor(self.jobs, mp_context=multiprocessing.get_context("spawn")) as pool:
            for key, out in zip(missing, pool.map(dense, *zip(*missing.values(), strict=True)), strict=True):
                self._keep(key, out)
        self.seconds += self.jobs * (time.monotonic() - started)

    def _file(self, key: str) -> Path | None:
        return self.cache / f"{key}.npy" if self.cache is not None else None

    def _keep(self, key: str, out: np.ndarray) -> None:
        self.runs += 1
        self._kept[key] = out
        file = self._file(key)
        if file is not None:
            part = file.with_suffix(".part.npy")
            np.save(part, out)
            part.replace(file)

    def _key(self, episode: ClothEpisode, effects: tuple[EffectEntry, ...], physics: dict[str, float]) -> str:
        h = hashlib.sha256()
        s = self.scene
        for x in (s.vertices, s.faces, s.stays, s.capsules, episode.t):
            h.update(np.ascontiguousarray(x).tobytes())
        for p in episode.pins:
            h.update(repr((p.vertices, p.release_t, None if p.path is None else p.path.tobytes())).encode())
        h.update(
            repr(
                (
                    s.physics,
                    s.markers,
                    episode.load is None,
                    sorted(physics.items()),
                    [(e.name, e.target, sorted(e.parameters.items())) for e in effects],
                )
            ).encode()
        )
        return h.hexdigest()[:24]


def canonical(effects: tuple[EffectEntry, ...]) -> tuple[tuple[EffectEntry, ...], tuple[EffectEntry, ...]]:
    """Effects that act in the simulation, and on the reading; those of zero size only bring their proxy bodies."""
    reading = tuple(e for e in effects if e.name in READING)
    acting, idle = [], False
    for e in effects:
        if e.name in READING:
            continue
        size = [e.parameters[k] for k in SIZES.get(e.name, ())]
        if size and not any(size):
            idle |= CLOTH_EFFECTS[e.name].needs_proxies
        else:
            acting.append(e)
    if idle and not any(CLOTH_EFFECTS[e.name].needs_proxies for e in acting):
        acting.append(EffectEntry(name="air_drag", target="cloth", parameters={"coefficient": 0.0}))
    return tuple(acting), reading


READING = frozenset({"delay", "offset"})
SIZES = {
    "air_drag": ("coefficient",),
    "wind": ("x", "y"),
    "tilted_gravity": ("towards_x", "towards_y"),
    "added_mass": ("mass",),
    "strain_stiffening": ("stiffness",),
    "contact_friction": ("change",),
    "adhesion": ("pressure",),
    "snag": ("stiffness",),
}


def simulate(
    scene: ClothScene, episode: ClothEpisode, effects: tuple[EffectEntry, ...], physics: dict[str, float]
) -> np.ndarray:
    """One run in a world of its own, read at the episode's times."""
    acting, reading = canonical(effects)
    return recorded(episode, dense(scene, episode, acting, physics), reading)


def recorded(episode: ClothEpisode, run: np.ndarray, reading: tuple[EffectEntry, ...]) -> np.ndarray:
    """A dense run as the sensors would have recorded it at the episode's times."""
    grid, path = run[:, 0], run[:, 1:-3].reshape(len(run), -1, 3)
    for e in reading:
        path = CLOTH_EFFECTS[e.name].read(grid, path, e.parameters)
    table = path.reshape(len(grid), -1)
    if episode.load is not None:
        table = np.concatenate([table, run[:, -3:]], axis=1)
    return np.stack([np.interp(episode.t, grid, column) for column in table.T], axis=1)


def dense(
    scene: ClothScene, episode: ClothEpisode, effects: tuple[EffectEntry, ...], physics: dict[str, float]
) -> np.ndarray:
    """One run sampled about twice as often as measured: (N, 1 + 3 M + 3) time, markers, load."""
    ph = {**scene.physics.__dict__, **physics}
    patch = ClothPatch(
        effects,
        scene.vertices,
        scene.faces,
        ph["mass"],
        ClothSettings(friction=ph["friction"], gravity=tuple(ph["gravity"])),
        pinned={i for pin in episode.pins for i in pin.vertices},
        capsules=scene.capsules,
        per_second=ph["per_second"],
    )
    with closing(SoftWorld(ph["time_step"], per_second=ph["per_second"], gravity=patch.settings.gravity)) as world:
        return _run(world, patch, scene, episode, ph)


def _run(
    world: SoftWorld, patch: ClothPatch, scene: ClothScene, episode: ClothEpisode, ph: dict[str, Any]
) -> np.ndarray:
    p, dt = world.client, world.time_step
    for c in scene.capsules:
        _capsule(p, c)
    cloth = world.load_cloth(
        scene.vertices,
        scene.sewn,
        mass=patch.cloth_mass,
        elastic=ph["elastic_stiffness"],
        damping=ph["damping_stiffness"],
        bending=ph["bending_stiffness"],
        friction=patch.settings.friction,
    )
    patch.attach(p, cloth)
    pull = world.unit.force(PULL)
    held: list[dict[str, Any] | None] = [
        _hold(world, cloth, pin, scene, k == 0 and episode.load is not None, ph["mass"], pull)
        for k, pin in enumerate(episode.pins)
    ]
    release = [pin.release_t for pin in episode.pins]
    if patch.release_t is not None and release:
        release[0] = min(release[0], patch.release_t)
    # sampled densely and read at the measured times, so that a delay can look before the first row
    every = max(1, round(float(np.median(np.diff(episode.t))) / dt / 2.0))
    steps = int(np.ceil(episode.t[-1] / dt)) + 1
    times, markers, loads = [0.0], [scene.vertices[list(scene.markers)]], [np.zeros(3)]
    ids = list(scene.markers)
    for k in range(steps):
        t = k * dt
        for j, (pin, hold) in enumerate(zip(episode.pins, held, strict=True)):
            if hold is not None and t >= release[j]:
                world.release(hold["anchors"])
                held[j] = hold = None
            if hold is not None and hold["drive"] is not None and pin.path is not None:
                at = hold["start"] + np.array([np.interp(t, pin.path[:, 0], pin.path[:, a]) for a in (1, 2, 3)])
                p.changeConstraint(hold["drive"], at.tolist(), maxForce=pull)
        patch.apply(t)
        world.step()
        if (k + 1) % every == 0 or k == steps - 1:
            times.append((k + 1) * dt)
            markers.append(world.vertices(cloth)[ids])
            first = held[0] if held else None
            loads.append(np.zeros(3) if first is None else _load(world, first, patch.settings.gravity))
    grid, path = np.array(times), np.array(markers)
    loads[0] = loads[1]
    out = np.column_stack([grid, path.reshape(len(grid), -1), np.array(loads)])
    return np.clip(np.nan_to_num(out, nan=50.0), -50.0, 50.0)  # a blown-up run must lose, not crash


def _hold(
    world: SoftWorld, cloth: int, pin: Pin, scene: ClothScene, measured: bool, total: float, pull: float
) -> dict[str, Any]:
    """Pin vertices: to the world where they never move, else to a body that is dragged along."""
    start = scene.vertices[list(pin.vertices)].mean(axis=0)
    mass = total * len(pin.vertices) / len(scene.vertices)
    if pin.path is None and not measured:
        return {
            "anchors": world.anchor(cloth, pin.vertices),
            "drive": None,
            "start": start,
            "mass": mass,
        }
    p = world.client
    body = p.createMultiBody(
        HAND, p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.005] * 3), basePosition=start.tolist()
    )
    p.setCollisionFilterGroupMask(body, -1, 0, 0)
    p.changeDynamics(
        body, -1, linearDamping=0.0, angularDamping=0.0, activationState=p.ACTIVATION_STATE_DISABLE_SLEEPING
    )
    drive = p.createConstraint(body, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], start.tolist())
    p.changeConstraint(drive, start.tolist(), maxForce=pull)
    anchors = world.anchor(cloth, pin.vertices, body)
    return {"anchors": anchors, "drive": drive, "start": start, "mass": mass}


def _load(world: SoftWorld, hold: dict[str, Any], gravity: tuple[float, float, float]) -> np.ndarray:
    """Force the cloth exerts on the first pin's body, own weight removed (3,) [N]."""
    if hold["drive"] is None:
        return np.zeros(3)
    force = np.array(world.client.getConstraintState(hold["drive"])[:3]) * world.unit.per_second**2
    # the constraint feels the free part of the cloth; the pinned vertices' own weight is carried too
    return -(force + HAND * np.array(gravity)) + hold["mass"] * np.array(gravity)


def _capsule(p: Any, c: np.ndarray) -> int:
    a, b, radius = c[:3], c[3:6], float(c[6])
    length = float(np.linalg.norm(b - a))
    if length < 1e-9:
        return p.createMultiBody(0, p.createCollisionShape(p.GEOM_SPHERE, radius=radius), basePosition=a.tolist())
    d = (b - a) / length
    axis = np.cross([0.0, 0.0, 1.0], d)
    sine = float(np.linalg.norm(axis))
    axis = axis / sine if sine > 1e-9 else np.array([1.0, 0.0, 0.0])
    turn = p.getQuaternionFromAxisAngle(axis.tolist(), float(np.arctan2(sine, d[2])))
    shape = p.createCollisionShape(p.GEOM_CAPSULE, radius=radius, height=length)
    return p.createMultiBody(0, shape, basePosition=((a + b) / 2).tolist(), baseOrientation=turn)
