"""The two engines of cloth beside each other: a towel on a slope, and a gown that hangs.

    python benchmarks/cloth_engines.py

Prints how far a towel of friction 0.4 creeps or slides in a second, and for a gown that hangs by three vertices of its
neckline the load, how far the engines are apart, and the processor time of a step.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from caretree.sim.bullet.engines import BULLET, SPRING, engine_named
from caretree.sim.bullet.handle import Handle
from caretree.sim.bullet.soft_world import GRAVITY, MARGIN
from caretree.sim.scene.gown import GOWNS, build_gown
from caretree.sim.scene.objects import Sheet, sheet_mesh

DT = 0.0025  # [s]
SLOPES = (0.1, 0.3, 0.36, 0.45, 0.6)  # tangents; the cone's is 0.4
HANGS = 14.0  # [s]


def slide(name: str, slope: float) -> float:
    """How far a towel comes in 1 s [m]."""
    engine = engine_named(name)
    room = engine.room(DT)
    angle, c = np.arctan(slope), room.client
    gravity = GRAVITY * np.array((np.sin(angle), 0.0, -np.cos(angle)))
    board = c.createMultiBody(
        0,
        c.createCollisionShape(c.GEOM_BOX, halfExtents=[4, 1, 0.05]),
        basePosition=[0, 0, -0.05],
        useMaximalCoordinates=int(engine.soft_bodies),
    )
    c.changeDynamics(board, -1, lateralFriction=0.5)
    mesh = sheet_mesh(Sheet(name="towel", size=(0.4, 0.4), position_in_map=(0.0, 0.0, 1.0), friction=0.8))
    cloth: Any = engine.cloth(room, mesh, mesh.vertices + (0, 0, MARGIN))
    if engine.soft_bodies:
        room.set_gravity(gravity)
    else:
        cloth.sheet.gravity = gravity
    for _ in range(round(1.0 / DT)):
        room.step()
    way = float(cloth.vertices()[:, 0].mean())
    room.close()
    return way


def hang(name: str) -> tuple[np.ndarray, np.ndarray, float]:
    """Vertices (2, V, 3) after 1 s and at the end [m], the load (3,) then [N] and the time of a step [s]."""
    engine = engine_named(name)
    room = engine.room(DT)
    mesh = build_gown(GOWNS["medium"])
    cloth = engine.cloth(room, mesh, mesh.vertices + (0, 0, 1.6))
    pose = np.eye(4)
    pose[:3, 3] = cloth.vertices()[mesh.collar[7]]
    near = np.argsort(np.linalg.norm(cloth.vertices() - pose[:3, 3], axis=1))[:3]
    handle = Handle(room.client, pose)
    cloth.pin(near, handle.body, handle.link)
    shown, loads, began = [], [], 0.0
    for k in range(round(HANGS / DT)):
        if k == 1:  # what is compiled has been
            began = time.process_time()
        handle.follow(pose)
        room.step()
        if k + 1 in (round(1.0 / DT), round(HANGS / DT)):
            shown.append(cloth.vertices())
        if k * DT > HANGS - 2.0:
            loads.append(cloth.load(near, cloth.vertices()))
    spent = (time.process_time() - began) / (HANGS / DT)
    room.close()
    return np.array(shown), np.mean(loads, axis=0), spent


def main() -> None:
    """Measure and print."""
    for slope in SLOPES:
        ways = ", ".join(f"{name} {slide(name, slope) * 1e3:.1f} mm" for name in (BULLET, SPRING))
        print(f"slope {slope}: {ways}", flush=True)
    seen = {}
    for name in (BULLET, SPRING):
        seen[name], load, spent = hang(name)
        print(
            f"{name}: pulls with {-load[2]:.2f} N of {GOWNS['medium'].mass * GRAVITY:.2f}, {spent * 1e6:.0f} us a step"
        )
    apart = np.linalg.norm(seen[BULLET] - seen[SPRING], axis=2).mean(axis=1)
    print(f"apart on average: {apart[0] * 100:.1f} cm after 1 s, {apart[1] * 100:.1f} cm after {HANGS:.0f} s")


if __name__ == "__main__":
    main()
