"""The hospital gown as a mesh: a wide open-backed sheet with two short tube sleeves.

Local frame of the rest shape: x across the gown towards the wearer's right, z up (the collar is the upper
edge at z = 0), y out of the gown's outside.  Unwrapped, a back-opening gown is a sheet: left back panel,
front panel, right back panel; its upper edge is the neckline, and the armholes lie just below it, so that
the strap above each armhole is the shoulder seam.

A sleeve is sewn with stays, the stiff tape of dressmakers: in cells of 5 cm, springs along the edges alone let a tube
fold without resistance, and every sleeve fell through its own armhole as soon as the gown lay slanted.  Real
sleeves do not: they resist as shells, and their seams are four layers thick.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np

from ..errors import CaretreeError

FABRIC, COLLAR, CUFF, ARMHOLE = range(4)  # face labels: plain fabric and the three contrasting bindings
MASS_MAX = 5.0  # [kg] more than any garment that a person is dressed in; grams are told by it


@dataclass(frozen=True, kw_only=True)
class GownSpec:
    """Cut and cloth of one gown.  Lengths are rounded to whole cells of the grid.

    Attributes:
        name: how the command line calls it.
        spacing: edge of the grid [m].
        front: cells between the two armholes.
        back: cells of each back panel, from the armhole to the free edge.
        hole: (across, down) cells of an armhole.
        strap: cells between the upper edge and an armhole.
        length: cells from collar to hem.
        sleeve: cells of a sleeve.
        mass: of the whole gown [kg].
        elastic: spring stiffness [N/m].
        bending: bending spring stiffness [N/m].
        damping: spring damping [N s/m].
        friction: Coulomb coefficient against skin and bed.
        air_drag: force of still air per area and squared speed; 0 is none [N s^2/m^4].
    """

    name: str
    spacing: float = 0.055
    front: int = 15
    back: int = 3
    hole: tuple[int, int] = (3, 4)
    strap: int = 1
    length: int = 18
    sleeve: int = 3
    mass: float = 0.45
    elastic: float = 45.0
    bending: float = 0.1
    damping: float = 0.006
    friction: float = 0.4
    air_drag: float = 0.0

    def __post_init__(self) -> None:
        """Reject cuts that cannot be sewn.

        Raises:
            CaretreeError: a size is not positive, it weighs what no gown does, or the armhole does not fit the length.
        """
        if (
            min(self.spacing, self.mass, self.elastic) <= 0
            or min(self.front, self.back, self.strap, self.sleeve, *self.hole) < 1
        ):
            raise CaretreeError(f"gown '{self.name}': sizes, mass and stiffness must be positive")
        if self.mass > MASS_MAX:
            raise CaretreeError(f"gown '{self.name}' weighs {self.mass:g} kg, but at most {MASS_MAX:g} kg is asked for")
        if self.strap + self.hole[1] >= self.length:
            raise CaretreeError(
                f"gown '{self.name}': an armhole of {self.hole[1]} cells does not fit a length of {self.length} cells"
            )


GOWNS: dict[str, GownSpec] = {
    spec.name: spec
    for spec in (
        GownSpec(name="medium"),
        GownSpec(name="large", spacing=0.056, length=19, mass=0.49, elastic=46.0, friction=0.38),
        GownSpec(name="light", spacing=0.054, mass=0.41, elastic=40.0, damping=0.005, friction=0.45),
    )
}
# Cuts that no seed draws and nothing is trained on: they are asked for by name.
HELD_OUT_GOWNS: dict[str, GownSpec] = {
    spec.name: spec
    for spec in (
        GownSpec(name="wide", spacing=0.056, front=17, back=4, hole=(3, 4), length=17),
        GownSpec(name="narrow", spacing=0.053, front=14, back=2, hole=(3, 5), length=19, sleeve=4),
        GownSpec(name="long_sleeved", front=15, back=3, hole=(4, 4), length=16, sleeve=5),
    )
}


@dataclass(frozen=True, kw_only=True)
class GownMesh:
    """Rest shape with its named landmarks.

    Attributes:
        spec: what it was cut from.
        vertices: (V, 3) local frame [m].
        faces: (F, 3) int, outward winding (normals towards +y).
        labels: (F,) int, `FABRIC` or one of the bindings.
        loops: `armhole_left`, `cuff_left`, `armhole_right`, `cuff_right` -> (n,) ordered vertex ids whose
            right-hand normal points from body to hand.
        collar: (n,) vertex ids of the neckline, the bound part of the upper edge, from the wearer's left to the right.
        corners: vertex ids of the two ends of the neckline, where it meets the shoulder seams, (left, right).
        front: (n,) vertex ids of the front panel.
        stays: (S, 3) int, triangles (a, b, c) along a seam or a sleeve whose spring from a to c keeps a-b-c from
            folding; nobody sees them.
    """

    spec: GownSpec
    vertices: np.ndarray
    faces: np.ndarray
    labels: np.ndarray
    loops: dict[str, np.ndarray]
    collar: np.ndarray
    corners: tuple[int, int]
    front: np.ndarray
    stays: np.ndarray

    @property
    def sewn(self) -> np.ndarray:
        """(F + S, 3) all triangles whose edges are springs: the faces and the stays."""
        return np.vstack([self.faces, self.stays])


def build_gown(spec: GownSpec) -> GownMesh:
    """Cut and sew a gown: pure geometry, no simulation."""
    across = spec.front + 2 * (spec.hole[0] + spec.back)
    holes = {
        "left": range(spec.back, spec.back + spec.hole[0]),
        "right": range(across - spec.back - spec.hole[0], across - spec.back),
    }
    rows = range(spec.strap, spec.strap + spec.hole[1])
    panel = range(holes["left"].stop, holes["right"].start)
    sewing = _Sewing([], [], [], [])
    index = _cut_sheet(spec, across, holes, rows, panel, sewing)
    loops: dict[str, np.ndarray] = {}
    for side, columns in holes.items():
        loop = _hole_loop(index, columns, rows)
        around = _hole_loop(index, columns, rows, out=1)  # the panel's vertices one cell off the armhole
        loops[f"armhole_{side}"] = np.array(loop)
        loops[f"cuff_{side}"] = np.array(_sew_sleeve(spec, around, loop, sewing))
    front = [n for (i, _), n in index.items() if panel.start <= i <= panel.stop]
    collar = np.array([index[i, 0] for i in range(panel.start, panel.stop + 1)])
    return GownMesh(
        spec=spec,
        vertices=np.array(sewing.vertices),
        faces=np.array(sewing.faces),
        labels=np.array(sewing.labels),
        loops=loops,
        collar=collar,
        corners=(int(collar[0]), int(collar[-1])),
        front=np.array(front),
        stays=np.array(sewing.stays),
    )


@dataclass(frozen=True)
class _Sewing:
    """What has been sewn so far: vertices [m], faces with their labels, stays."""

    vertices: list[np.ndarray]
    faces: list[tuple[int, int, int]]
    labels: list[int]
    stays: list[tuple[int, int, int]]


def _cut_sheet(
    spec: GownSpec, across: int, holes: dict[str, range], rows: range, panel: range, sewing: _Sewing
) -> dict[tuple[int, int], int]:
    """Lay out the sheet with its armholes; returns (column, row) -> vertex id."""
    xs = (np.arange(across + 1) - across / 2) * spec.spacing
    zs = -np.arange(spec.length + 1) * spec.spacing
    cells = [
        (i, j)
        for j in range(spec.length)
        for i in range(across)
        if not (j in rows and any(i in columns for columns in holes.values()))
    ]
    used = sorted({(i + a, j + b) for i, j in cells for a in (0, 1) for b in (0, 1)})
    index = {key: n for n, key in enumerate(used)}
    sewing.vertices.extend(np.array((xs[i], 0.0, zs[j])) for i, j in used)
    for i, j in cells:
        a, b, c, d = index[i, j], index[i + 1, j], index[i, j + 1], index[i + 1, j + 1]
        # alternate the diagonal: a sheet with all diagonals one way shears more easily the other way
        sewing.faces.extend([(a, b, c), (b, d, c)] if (i + j) % 2 else [(a, b, d), (a, d, c)])
        sewing.labels.extend([COLLAR if j == 0 and i in panel else FABRIC] * 2)
    return index


def _sew_sleeve(spec: GownSpec, around: list[int], armhole: list[int], sewing: _Sewing) -> list[int]:
    """Sew a tube to an armhole, and stays along it; returns the vertex ids of its cuff."""
    rings = [around, armhole]
    for step in range(1, spec.sleeve + 1):
        ring, fresh = rings[-1], []
        for k in armhole:
            fresh.append(len(sewing.vertices))
            sewing.vertices.append(sewing.vertices[k] + (0.0, step * spec.spacing, 0.0))
        label = CUFF if step == spec.sleeve else ARMHOLE if step == 1 else FABRIC
        for q in range(len(armhole)):
            after = (q + 1) % len(armhole)
            a, b, c, d = ring[q], ring[after], fresh[q], fresh[after]
            sewing.faces.extend([(a, b, d), (a, d, c)] if q % 2 else [(a, b, c), (b, d, c)])
            sewing.labels.extend([label] * 2)
        rings.append(fresh)
    for three in zip(rings, rings[1:], rings[2:], strict=False):
        sewing.stays.extend(zip(*three, strict=True))
    # the binding is a tape
    sewing.stays.extend(zip(armhole[-1:] + armhole[:-1], armhole, armhole[1:] + armhole[:1], strict=True))
    return rings[-1]


def _hole_loop(index: dict[tuple[int, int], int], columns: range, rows: range, out: int = 0) -> list[int]:
    """Vertex ids around a hole, or square off it by `out` cells; the right-hand normal is +y (z turns into x)."""
    i0, i1, j0, j1 = columns.start, columns.stop, rows.start, rows.stop
    path = (
        [(i, j0 - out) for i in range(i0, i1)]
        + [(i1 + out, j) for j in range(j0, j1)]
        + [(i, j1 + out) for i in range(i1, i0, -1)]
        + [(i0 - out, j) for j in range(j1, j0, -1)]
    )
    return [index[key] for key in path]


def edge_counts(faces: np.ndarray) -> Counter[tuple[int, int]]:
    """How many faces share each undirected edge (1: a border)."""
    pairs = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return Counter((int(a), int(b)) for a, b in pairs)


def without_cloth(mesh: GownMesh) -> GownMesh:
    """The mesh of no gown at all: nothing but the names of its landmarks."""
    none = np.zeros(0, dtype=int)
    return replace(
        mesh,
        vertices=np.zeros((0, 3)),
        faces=np.zeros((0, 3), dtype=int),
        labels=none,
        loops=dict.fromkeys(mesh.loops, none),
        collar=none,
        front=none,
        stays=np.zeros((0, 3), dtype=int),
    )
