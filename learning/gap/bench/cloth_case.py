"""Hidden cases for cloth: a sheet that swings, falls over a limb or is dragged across it, recorded from PyBullet.

Effects go into the recording world as loads on its own proxy bodies and through its own settings; the truth is kept
apart.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import yaml

from ....sim.effects.cloth.cloth_registry import CLOTH_EFFECTS
from ....sim.effects.model_file import EffectEntry
from ....sim.obj_file import write_obj
from ..cloth.scene import ClothEpisode, read_scene
from ..cloth.simulate import simulate
from ..measurement import Episode, MeasurementSet
from .case import STEPS, Truth, coloured, draw_kind, rounded

STILL = EffectEntry(name="wind", target="cloth", parameters={"x": 1e-6, "y": 0.0})
LEAST = 0.5  # size over the noise below which nothing is hidden: another effect is drawn instead
IDLE = EffectEntry(name="air_drag", target="cloth", parameters={"coefficient": 0.0})
INSIDE = (
    "air_drag",
    "wind",
    "tilted_gravity",
    "added_mass",
    "strain_stiffening",
    "contact_friction",
    "adhesion",
    "snag",
    "grip_slip",
    "delay",
    "offset",
)


def write_cloth_case(seed: int, folder: Path) -> Truth:
    """Write one set for `cloth` into `folder` and return what it hides."""
    rng = np.random.default_rng([seed, 3])
    kind = draw_kind(rng)
    truth = Truth(system="cloth", seed=seed, kind=kind)
    vertices, faces, n, m = _sheet(rng)
    write_obj(folder / "sheet.obj", vertices, faces)
    limb = rng.random() < 0.5
    mass = float(rng.uniform(0.06, 0.2))
    physics = {
        "mass": round(mass, 4),
        "elastic_stiffness": float(rng.choice([30.0, 40.0, 60.0])),
        "damping_stiffness": float(rng.choice([0.004, 0.008])),
        "bending_stiffness": 0.1,
        "friction": 0.4,
        "gravity": -9.81,
    }
    capsules = []
    if limb:
        centre = vertices.mean(axis=0) + [0.0, 0.06, -0.05]
        capsules = [
            {
                "a": (centre - [0.4, 0, 0]).round(4).tolist(),
                "b": (centre + [0.4, 0, 0]).round(4).tolist(),
                "radius": 0.05,
            }
        ]
    markers = sorted(
        {int(j * n + i) for j in np.linspace(0, m - 1, 4).astype(int) for i in np.linspace(0, n - 1, 4).astype(int)}
    )
    episodes, count, duration = [], 3, 1.0
    t = np.arange(0.0, duration, 1.0 / 60.0)
    for e in range(count):
        pins, header = _pins(rng, folder, e, n, t)
        episodes.append((f"episode_{e + 1}", pins))
    listed = [
        {"file": f"{name}.csv", "role": "heldout" if k == count - 1 else "fit", "pins": pins}
        for k, (name, pins) in enumerate(episodes)
    ]
    header = {"system": "cloth", "mesh": "sheet.obj", "physics": physics, "markers": markers, "capsules": capsules}
    blank = {"t": t, **{f"m{k}{a}": vertices[i][j] + 0 * t for k, i in enumerate(markers) for j, a in enumerate("xyz")}}
    measured = MeasurementSet(
        folder=folder,
        system="cloth",
        settings=header,
        episodes=tuple(
            Episode(name=name, file=folder / f"{name}.csv", role="fit", columns=blank, settings={"pins": pins})
            for name, pins in episodes
        ),
    )
    scene, parsed = read_scene(measured)
    noise = float(rng.uniform(0.0008, 0.002))
    step = noise * float(np.random.default_rng([seed, 3, 1]).choice(STEPS))
    effects, changed = _draw(rng, kind, truth, vertices, limb, duration, noise, scene, parsed)
    for e in parsed:
        x = simulate(scene, e, effects, changed)
        if kind == "outside":
            x = _outside(rng, truth, x, e, noise)
        x = x + np.stack([coloured(rng, len(t), t[1], noise) for _ in range(x.shape[1])], axis=1)
        x = rounded(x, step)
        names = [f"m{k}{a}" for k in range(len(markers)) for a in "xyz"]
        np.savetxt(
            folder / f"{e.name}.csv",
            np.column_stack([t, x]),
            delimiter=",",
            header=",".join(["t", *names]),
            comments="",
            fmt="%.6g",
        )
    (folder / "measurement.yaml").write_text(yaml.safe_dump({**header, "episodes": listed}, sort_keys=False))
    return truth


def _sheet(rng: np.random.Generator):
    n, m, h = int(rng.integers(6, 9)), int(rng.integers(6, 9)), 0.07
    v = np.array([(i * h, 0.0, 1.5 - j * h) for j in range(m) for i in range(n)])
    f = [(a, a + n, a + 1) for j in range(m - 1) for a in range(j * n, j * n + n - 1)]
    f += [(a + 1, a + n, a + n + 1) for j in range(m - 1) for a in range(j * n, j * n + n - 1)]
    return v, np.array(f), n, m


def _pins(rng: np.random.Generator, folder: Path, e: int, n: int, t: np.ndarray):
    """Two corners, of which one may move or be let go."""
    left, right = [0, 1], [n - 2, n - 1]
    if rng.random() < 0.35:
        return [{"vertices": left}, {"vertices": right, "release_t": float(rng.uniform(0.05, 0.4))}], None
    reach = rng.uniform(-0.15, 0.15, 3) * [1, 1.6, 1]
    rise = np.clip(t / rng.uniform(0.5, 1.0), 0, 1)
    path = (10 * rise**3 - 15 * rise**4 + 6 * rise**5)[:, None] * reach
    file = folder / f"path_{e + 1}.csv"
    np.savetxt(file, np.column_stack([t, path]), delimiter=",", header="t,x,y,z", comments="", fmt="%.6g")
    return [
        {"vertices": left, "path": file.name},
        {"vertices": right, "path": file.name} if rng.random() < 0.5 else {"vertices": right},
    ], None


def _draw(rng, kind, truth, vertices, limb, duration, noise, scene, parsed):
    changed: dict[str, float] = {}
    if kind == "recalibration":
        key = str(rng.choice(["elastic_stiffness", "damping_stiffness"]))
        changed[key] = scene.physics.__dict__[key] * float(rng.choice([0.55, 1.8]))
        truth.effects = [{"name": key, "target": "cloth", "size": float("nan"), "values": {key: changed[key]}}]
    pool = [n for n in INSIDE if limb or n not in ("contact_friction", "adhesion")]
    names = [str(n) for n in rng.choice(pool, size={"single": 1, "two": 2}.get(kind, 0), replace=False)]
    if set(names) == {"wind", "tilted_gravity"}:
        names = [names[0], "delay"]
    entries = []
    spare = [n for n in pool if n not in names and not {n, *names} >= {"wind", "tilted_gravity"}]
    for name in names:
        size = float(np.exp(rng.uniform(np.log(0.7), np.log(6.0))))
        entry, got = _sized(rng, name, size, vertices, duration, noise, scene, parsed)
        while got < LEAST:  # cloth that hardly touches the limb shows no friction, however much is changed
            name = spare.pop(int(rng.integers(len(spare))))
            entry, got = _sized(rng, name, size, vertices, duration, noise, scene, parsed)
        entries.append(entry)
        values = {k: float(v) for k, v in entry.parameters.items()}
        truth.effects.append({"name": name, "target": _target(name), "size": got, "values": values})
        if name == "snag":
            v = entry.parameters
            truth.intervals += [(e.name, v["t0"], v["t1"]) for e in parsed]
    return tuple(entries), changed


def _target(name: str) -> str:
    return {"added_mass": "region", "snag": "region", "grip_slip": "pin 1"}.get(name, "cloth")


def _sized(rng, name, size, vertices, duration, noise, scene, parsed):
    """Scale an effect until it moves the markers by about `size` times the noise in the first episode."""
    place = vertices[int(rng.integers(len(vertices)))]
    direction = rng.normal(size=2)
    direction /= np.linalg.norm(direction)
    t0 = float(rng.uniform(0.2, 0.5) * duration)
    make = {
        "air_drag": lambda s: {"coefficient": 1.0 * s},
        "wind": lambda s: {"x": 1.0 * s * direction[0], "y": 1.0 * s * direction[1]},
        "tilted_gravity": lambda s: {"towards_x": 0.03 * s * direction[0], "towards_y": 0.03 * s * direction[1]},
        "added_mass": lambda s: {
            "mass": 0.01 * s,
            "x": float(place[0]),
            "y": 0.0,
            "z": float(place[2]),
            "radius": 0.12,
        },
        "strain_stiffening": lambda s: {"stiffness": 20.0 * s, "onset": 0.01 + 0.05 * float(direction[0] ** 2)},
        "contact_friction": lambda s: {"change": float(min(0.3 * s, 2.0))},
        "adhesion": lambda s: {"pressure": 5.0 * s},
        "snag": lambda s: {
            "stiffness": min(3.0 * s, 300.0),
            "x": float(place[0]),
            "y": 0.0,
            "z": float(place[2]),
            "t0": t0,
            "t1": float(min(t0 + 0.4 * duration, duration)),
        },
        "grip_slip": lambda s: {"time": t0},
        "delay": lambda s: {"time": min(0.01 * s, 0.2)},
        "offset": lambda s: {"x": 0.002 * s * float(direction[0]), "y": 0.002 * s * float(direction[1]), "z": 0.0},
    }[name]
    idle = (IDLE,) if CLOTH_EFFECTS[name].needs_proxies else ()  # what proxy bodies do alone is not the effect's size
    idle = (STILL,) if name == "wind" else idle  # nor what still air does: a wind of nothing is air drag
    base = [simulate(scene, e, idle, {}) for e in parsed[:2]]
    s, got = 1.0, 0.0
    entry = EffectEntry(name=name, target=_target(name), parameters=make(s))
    for _ in range(1 if name == "grip_slip" else 5):
        entry = EffectEntry(name=name, target=_target(name), parameters=make(s))
        got = (
            float(
                np.sqrt(
                    np.mean(
                        [(simulate(scene, e, (entry,), {}) - b) ** 2 for e, b in zip(parsed[:2], base, strict=True)]
                    )
                )
            )
            / noise
        )
        if name == "grip_slip" or abs(np.log(max(got, 1e-3) / size)) < 0.15:
            break
        s = float(np.clip(s * (size / max(got, 1e-2)), 0.05 * s, 20.0 * s))
    return entry, got


def _outside(rng: np.random.Generator, truth: Truth, x: np.ndarray, e: ClothEpisode, noise: float) -> np.ndarray:
    """Disagreements no effect of the registry makes: a breathing scale, a bent view, a tremor of the camera."""
    if not truth.note:
        truth.note = str(rng.choice(["breathing", "lens", "tremor"]))
        truth.effects = [
            {"name": truth.note, "target": "cloth", "size": float(np.exp(rng.uniform(np.log(2), np.log(6))))}
        ]
    size = truth.effects[0]["size"] * noise
    p = x.reshape(len(x), -1, 3)
    c = p.mean(axis=(0, 1))
    if truth.note == "breathing":
        change = np.sin(2 * np.pi * 1.3 * e.t)[:, None, None] * (p - c)
    elif truth.note == "lens":
        change = (p - c) * np.sum((p - c) ** 2, axis=2, keepdims=True)
    else:
        change = np.zeros_like(p)
        change[..., 0] = np.sin(2 * np.pi * 3.1 * e.t)[:, None]
    return x + (change * size / np.sqrt(np.mean(change**2))).reshape(x.shape)
