"""Parameter selection: which number of the gown moves a clip most, besides the five that the world knows.

Candidates are what PyBullet's `loadSoftBody` offers beyond mass, stiffness, bending, damping and friction, and the
drag of the air.  The size is none: it is known from the cut.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....sim.bullet.soft_world import MARGIN
from ....sim.scene.gown import GOWNS, GownSpec
from ..clips.camera import standard_camera
from ..clips.parameters import BASE, NAMES
from ..engine.bullet import bullet_fall
from ..engine.fall import cut_of, fall, rest

FACTOR = 2.0  # what each number is multiplied by


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """How much one change moves the clip.

    Attributes:
        name: what is changed.
        moves: root mean square change of the depth where both clips show gown [mm].
        lost: share of the gown's pixels that only one of the two clips shows.
    """

    name: str
    moves: float
    lost: float


def candidates() -> list[Candidate]:
    """Every candidate on the base gown, the most telling first."""
    base: GownSpec = replace(GOWNS["medium"], **dict(zip(NAMES, BASE.tolist(), strict=True)))
    still = replace(base, air_drag=0.0)
    start, calm = rest(base), rest(still)
    plain, bullet = _depth(base, fall(base, start)), _depth(still, bullet_fall(still, calm))
    found = []
    for name in NAMES:
        other = replace(base, **{name: FACTOR * getattr(base, name)})
        found.append(_candidate(f"{name} x {FACTOR:g}", plain, _depth(other, fall(other, rest(other)))))
    found.append(_candidate("no air at all", plain, _depth(still, fall(still, start))))
    for name, options in (
        (f"collision margin x {FACTOR:g}", {"collisionMargin": FACTOR * MARGIN}),
        ("self-collision on", {"useSelfCollision": 1}),
        ("self-collision on, repulsion 1 N/m", {"useSelfCollision": 1, "repulsionStiffness": 1e-8}),
        ("damping along springs only", {"springDampingAllDirections": 0}),
    ):
        found.append(_candidate(name, bullet, _depth(still, bullet_fall(still, calm, options=options))))
    slippery, rough = (
        _depth(still, bullet_fall(replace(still, friction=value), calm, options={"useSelfCollision": 1}))
        for value in (0.04, 2.0)
    )
    found.append(_candidate("friction 0.04 or 2 with self-collision on", slippery, rough))
    return sorted(found, key=lambda one: -one.moves)


def _depth(spec: GownSpec, path: np.ndarray) -> np.ndarray:
    mesh, _ = cut_of(spec)
    camera = standard_camera()
    return np.array([camera.look(mesh, x) for x in path])


def _candidate(name: str, before: np.ndarray, after: np.ndarray) -> Candidate:
    one, other = np.isfinite(before), np.isfinite(after)
    change = (after - before)[one & other]
    return Candidate(
        name=name, moves=float(np.sqrt((change**2).mean()) * 1e3), lost=float((one != other).sum() / one.sum())
    )


def report(found: list[Candidate]) -> str:
    """The table as Markdown."""
    return "\n".join(
        [
            "| change to the base gown | moves the clip [mm] | pixels lost or won [%] |",
            "|---|---|---|",
            *(f"| {one.name} | {one.moves:.1f} | {100 * one.lost:.1f} |" for one in found),
        ]
    )
