"""The fall of a released gown in PyBullet: what `mass_spring.py` is checked against, and a second source of clips.

Two traps of PyBullet 3.2.7 are avoided here.  A cloth's rest lengths are taken anew at the first step and whenever a
vertex is pinned to, or released from, the world (`setMass` marks the constants as stale): the gown must make a step
in its rest shape before it is put where it hangs, and a vertex once pinned to the world must not be released.  So
the released vertex is never pinned: the simulation begins at the instant of release.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import closing
from dataclasses import replace
from typing import Any

import numpy as np

from ....sim.bullet.cloth import Cloth
from ....sim.bullet.soft_world import GRAVITY, SoftWorld
from ....sim.bullet.units import PER_SECOND
from ....sim.effects.cloth.cloth_effect import ClothSettings
from ....sim.effects.cloth.proxy_bodies import PROXY_MASS, ClothPatch
from ....sim.effects.model_file import EffectEntry
from ....sim.errors import CaretreeError
from ....sim.scene.gown import GownSpec
from .fall import CLAMP_MASS, FRAMES, RATE, cut_of, steps_per_frame


def bullet_fall(
    spec: GownSpec,
    start: np.ndarray,
    frames: int = FRAMES,
    clamp: float = CLAMP_MASS,
    options: Mapping[str, Any] | None = None,
) -> np.ndarray:
    """(frames, V, 3) vertices at the instants of the frames, from `start` (V, 3) with one vertex let go [m].

    The air acts on 12 to 60 proxy bodies, not on every vertex, and their mass is taken off the cloth.

    Args:
        spec: the gown.
        start: where it hangs.
        frames: how many.
        clamp: mass on the released vertex [kg].
        options: of PyBullet's `loadSoftBody`, to try what they change.

    Raises:
        CaretreeError: with air, a gown lighter than its proxy bodies.
    """
    mesh, _ = cut_of(spec)
    steps = steps_per_frame(spec, len(start))
    patch = None
    if spec.air_drag > 0:
        air = EffectEntry(name="air_drag", target="cloth", parameters={"coefficient": spec.air_drag})
        settings = ClothSettings(friction=spec.friction, gravity=(0.0, 0.0, -GRAVITY))
        patch = ClothPatch((air,), mesh.vertices, mesh.faces, spec.mass, settings, set(mesh.corners), None, PER_SECOND)
        if patch.cloth_mass < spec.mass / 2:
            raise CaretreeError(
                f"gown '{spec.name}' weighs {spec.mass * 1e3:.0f} g, with air PyBullet needs more than "
                f"{2e3 * PROXY_MASS * len(patch.vertices):.0f} g"
            )
        spec = replace(spec, mass=patch.cloth_mass)
        steps = max(steps, steps_per_frame(spec, len(start)))
    time_step = 1.0 / RATE / steps
    with closing(SoftWorld(time_step)) as world:
        client = world.client
        cloth = Cloth(world, replace(mesh, spec=spec), mesh.vertices, options)
        cloth.pin([mesh.corners[0]])
        world.step()  # takes the rest lengths
        cloth.place(start)
        if clamp > 0:
            shape = client.createCollisionShape(client.GEOM_SPHERE, radius=0.004)
            body = client.createMultiBody(clamp, shape, basePosition=start[mesh.corners[1]].tolist())
            client.setCollisionFilterGroupMask(body, -1, 0, 0)
            client.changeDynamics(
                body,
                -1,
                linearDamping=0.0,
                angularDamping=0.0,
                activationState=client.ACTIVATION_STATE_DISABLE_SLEEPING,
            )
            cloth.pin([mesh.corners[1]], body)
        if patch is not None:
            patch.attach(client, cloth.body, start)
        out = [cloth.vertices()]
        for frame in range(frames - 1):
            for step in range(steps):
                if patch is not None:
                    patch.apply((frame + step / steps) / RATE)
                world.step()
            out.append(cloth.vertices())
    return np.array(out)
