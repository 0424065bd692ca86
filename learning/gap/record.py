"""Record a measurement set from the dressing world's own gown, with or without the effects of a model file.

The gown, its material, its time step and its units of time are the world's; it hangs from a few of its vertices and
is let go from its cut shape.  With an effect switched on this makes a set whose answer is known; with the model file
the workflow found it shows whether the gown now moves as recorded.
"""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import numpy as np
import yaml

from ...sim.effects.cloth.gown_patch import gown_effects, with_air
from ...sim.effects.cloth.proxy_bodies import spread_vertices
from ...sim.effects.model_file import EffectModel
from ...sim.obj_file import write_obj
from ...sim.scene.gown import GownMesh
from .errors import GapError
from .table import write_table

MARKERS = 20
RATE = 60.0  # [1/s]
NOISE = 0.001  # [m], of every marker coordinate
HEIGHT = 2.0  # [m] at which the gown's origin starts


def record(
    gown: str, model: str | None, out: Path, seed: int = 0, duration: float = 1.2, noise: float = NOISE
) -> list[Path]:
    """Hang a gown of the dressing world from three different places and write what markers on it do.

    Args:
        gown: name of a gown, or path of a gown file.
        model: model file with effects that act while recording, or None.
        out: folder of the measurement set.
        seed: of the markers' noise.
        duration: of each recording [s].
        noise: root mean square of each marker coordinate [m].

    Returns:
        The files written.

    Raises:
        CaretreeError: an unknown gown, or a model file that does not fit one.
        GapError: a duration that is too short to move.
    """
    from ...sim.bullet.coupled_room import TIME_STEP
    from ...sim.bullet.soft_world import GRAVITY
    from ...sim.bullet.units import PER_SECOND
    from ...sim.scene.gown import build_gown
    from ...sim.scene.scene import named_gown

    if not duration >= 0.5:
        raise GapError(f"--duration is {duration:g} s, at least 0.5 s are needed")
    mesh = build_gown(named_gown(gown))
    effects = None if model is None else gown_effects(model)
    if mesh.spec.air_drag > 0:
        effects = with_air(effects, mesh.spec.air_drag)
    start = mesh.vertices + (0.0, 0.0, HEIGHT - float(mesh.vertices[:, 2].max()))
    markers = np.sort(spread_vertices(mesh.vertices, MARKERS, set()))
    rng = np.random.default_rng([seed, 4])
    out.mkdir(parents=True, exist_ok=True)
    write_obj(out / "gown.obj", start, mesh.faces, mesh.stays)
    written, listed = [], []
    for k, pins in enumerate(_places(mesh)):
        t, paths = hung_path(mesh, start, pins, effects, duration, TIME_STEP)
        x = paths[:, markers].reshape(len(t), -1)
        x = x + rng.normal(size=x.shape) * noise
        names = [f"m{i}{a}" for i in range(len(markers)) for a in "xyz"]
        file = out / f"hung_{k + 1}.csv"
        write_table(file, {"t": t, **dict(zip(names, x.T, strict=True))})
        written.append(file)
        listed.append({"file": file.name, "role": "heldout" if k == 2 else "fit", "pins": [{"vertices": pins}]})
    spec = mesh.spec
    physics = {
        "mass": spec.mass,
        "elastic_stiffness": spec.elastic,
        "damping_stiffness": spec.damping,
        "bending_stiffness": spec.bending,
        "friction": spec.friction,
        "gravity": -GRAVITY,
        "time_step": TIME_STEP,
        "per_second": PER_SECOND,
    }
    header = {"system": "cloth", "mesh": "gown.obj", "physics": physics, "markers": [int(i) for i in markers]}
    (out / "measurement.yaml").write_text(yaml.safe_dump({**header, "episodes": listed}, sort_keys=False))
    return written


def _places(mesh: GownMesh) -> list[list[int]]:
    """Vertices it hangs from: the two corners of the neckline, the left one and the collar's middle, both cuffs."""
    middle = int(mesh.collar[len(mesh.collar) // 2])
    cuffs = [int(mesh.loops[f"cuff_{side}"][0]) for side in ("left", "right")]
    return [[int(c) for c in mesh.corners], [int(mesh.corners[0]), middle], cuffs]


def hung_path(
    mesh: GownMesh, start: np.ndarray, pins: list[int], effects: EffectModel | None, duration: float, time_step: float
) -> tuple[np.ndarray, np.ndarray]:
    """Times (T,) [s] and vertices (T, V, 3) [m] of one recording.

    Args:
        mesh: the gown.
        start: (V, 3) where it is let go, at rest [m].
        pins: vertices that stay.
        effects: checked model file, or None.
        duration: [s].
        time_step: of the physics [s].
    """
    from ...sim.bullet.cloth import load_gown
    from ...sim.bullet.soft_world import SoftWorld

    with closing(SoftWorld(time_step)) as world:
        cloth, patch = load_gown(world, mesh, start, effects, pins)
        held = cloth.pin(pins)
        wanted = np.arange(0.0, duration, 1.0 / RATE)
        grid, path = [0.0], [start]
        for k in range(int(np.ceil(duration / time_step)) + 1):
            if patch is not None:
                patch.apply(k * time_step)
                if patch.release_t is not None and k * time_step >= patch.release_t:
                    cloth.unpin(held)
                    patch.release_t = None
            world.step()
            grid.append((k + 1) * time_step)
            path.append(cloth.vertices())
    every = np.array(path).reshape(len(grid), -1)
    sampled = np.stack([np.interp(wanted, grid, column) for column in every.T], axis=1)
    return wanted, sampled.reshape(len(wanted), -1, 3)
