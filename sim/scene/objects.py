"""What a task brings into the room, as data: boxes, meshes, robots' description files, and sheets of cloth.

    world.add(Box(name="table", size=(0.4, 0.6, 0.7), position_in_map=(1.4, 0.8, 0.35)))
    world.add(MeshObject(name="cup", file="cup.obj", position_in_map=(1.4, 0.8, 0.75), mass=0.2))
    world.add(Sheet(name="towel", size=(0.4, 0.6), position_in_map=(1.4, 0.8, 0.8)))

A world that can hold them is `SupportsObjects` (`sim/abilities.py`).
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import CaretreeError
from ..obj_file import read_obj
from .gown import FABRIC, GownMesh, GownSpec

Vector3 = tuple[float, float, float]
Colour = tuple[float, float, float]  # red, green, blue, 0-255
GREY: Colour = (150.0, 150.0, 150.0)
ROOM_SIZE = 10.0  # [m] what is farther away, or larger, is not in this room
MASS_MAX = 200.0  # [kg]
CELLS_MAX = 2000  # of a sheet: its physics costs as much as three gowns then


class ObjectError(CaretreeError):
    """An object that cannot be, or a name that is taken."""


@dataclass(frozen=True, kw_only=True)
class RoomObject:
    """What all objects have.

    Attributes:
        name: of letters, digits and underscores; the record calls its state `object_NAME`.
        position_in_map: (x, y, z) of its middle, of a mesh's or a description's own origin [m].
        yaw: turned about the vertical [rad].
        friction: Coulomb coefficient.
        colour: red, green, blue, 0-255.
    """

    name: str
    position_in_map: Vector3
    yaw: float = 0.0
    friction: float = 0.5
    colour: Colour = GREY

    def __post_init__(self) -> None:
        """Refuse what physics could not take.

        Raises:
            ObjectError: a name, a number or a file will not do; says which.
        """
        if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", str(self.name)):
            raise ObjectError(f"{self.name!r} is no name for an object: letters, digits and underscores are asked for")
        self._numbers("position_in_map", self.position_in_map, 3, -ROOM_SIZE, ROOM_SIZE)
        self._numbers("colour", self.colour, 3, 0.0, 255.0)
        self._numbers("yaw", (self.yaw,), 1, -100.0, 100.0)
        self._numbers("friction", (self.friction,), 1, 0.0, 10.0)

    def _numbers(self, what: str, values: object, count: int, low: float, high: float) -> None:
        try:
            found = np.array(values, dtype=float)
        except (TypeError, ValueError):
            found = np.full(0, np.nan)
        if found.shape != (count,) or not ((found >= low) & (found <= high)).all():
            asked = f"{count} numbers from" if count > 1 else "a number from"
            shown = values[0] if isinstance(values, tuple) and count == 1 else values
            raise ObjectError(
                f"object {self.name!r}: {what} is {shown!r}, but {asked} {low:g} to {high:g} are asked for"
            )


@dataclass(frozen=True, kw_only=True)
class Box(RoomObject):
    """A solid box.

    Attributes:
        size: length of its edges [m].
        mass: 0 for one that nothing moves [kg].
        stiffness: of its skin in contact, None for one as hard as wood; a sponge has about 500 [N/m].
    """

    size: Vector3
    mass: float = 0.0
    stiffness: float | None = None

    def __post_init__(self) -> None:
        """As every object, and its size, mass and stiffness."""
        super().__post_init__()
        self._numbers("size", self.size, 3, 1e-3, ROOM_SIZE)
        self._numbers("mass", (self.mass,), 1, 0.0, MASS_MAX)
        if self.stiffness is not None:
            self._numbers("stiffness", (self.stiffness,), 1, 10.0, 1e6)


@dataclass(frozen=True, kw_only=True)
class MeshObject(RoomObject):
    """A rigid body of a triangle mesh; where it touches things it is as large as its convex hull.

    Attributes:
        file: OBJ file, in metres.
        mass: 0 for one that nothing moves [kg].
    """

    file: str | Path
    mass: float = 0.0

    def __post_init__(self) -> None:
        """As every object, and its file."""
        super().__post_init__()
        self._numbers("mass", (self.mass,), 1, 0.0, MASS_MAX)
        try:
            self.mesh()
        except CaretreeError as error:
            raise ObjectError(f"object {self.name!r}: {error}") from error

    def mesh(self) -> tuple[np.ndarray, np.ndarray]:
        """Vertices (V, 3) [m] and triangles (F, 3) of the file."""
        vertices, faces, _ = read_obj(Path(self.file))
        return vertices, faces


@dataclass(frozen=True, kw_only=True)
class UrdfObject(RoomObject):
    """A body of a URDF file, whose masses and frictionless joints hold; seen by its collision shapes.

    Attributes:
        file: URDF file.
        fixed: whether its base stays where it is.
    """

    file: str | Path
    fixed: bool = True

    def __post_init__(self) -> None:
        """As every object, and its file."""
        super().__post_init__()
        if not Path(self.file).is_file():
            raise ObjectError(f"object {self.name!r}: {self.file} is not there")


@dataclass(frozen=True, kw_only=True)
class Sheet(RoomObject):
    """A rectangle of cloth: a towel, a blanket.  It starts flat, at rest, and falls onto what is below it.

    Attributes:
        size: of its two edges, before it is turned along x and y [m].
        spacing: edge of the grid of its vertices [m].
        mass: of the whole sheet [kg].
        elastic: spring stiffness [N/m].
        bending: bending spring stiffness [N/m].
        damping: spring damping [N s/m].
        hung_by: where it hangs from a hook, as shares (0 to 1) of its two edges; it then starts upright, its second
            edge vertical, that place at `position_in_map`.
    """

    size: tuple[float, float]
    spacing: float = 0.05
    mass: float = 0.2
    elastic: float = 40.0
    bending: float = 0.1
    damping: float = 0.005
    hung_by: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        """As every object, and its cloth."""
        super().__post_init__()
        self._numbers("size", self.size, 2, 0.05, ROOM_SIZE)
        self._numbers("spacing", (self.spacing,), 1, 0.01, 0.2)
        self._numbers("mass", (self.mass,), 1, 0.01, 10.0)
        for what in ("elastic", "bending", "damping"):
            self._numbers(what, (getattr(self, what),), 1, 0.0, 1e4)
        if self.hung_by is not None:
            self._numbers("hung_by", self.hung_by, 2, 0.0, 1.0)
        cells = self.cells
        if min(cells) < 1 or cells[0] * cells[1] > CELLS_MAX:
            raise ObjectError(
                f"object {self.name!r}: a sheet of {cells[0]} by {cells[1]} cells of {self.spacing:g} m; "
                f"1 to {CELLS_MAX} of them are asked for"
            )

    @property
    def cells(self) -> tuple[int, int]:
        """Number of cells along its two edges."""
        return round(self.size[0] / self.spacing), round(self.size[1] / self.spacing)


def sheet_mesh(spec: Sheet) -> GownMesh:
    """The mesh of a sheet, in the frame of its middle: a gown's, without its landmarks.

    The diagonals of its cells alternate, so that it is alike in all directions.
    """
    nx, ny = spec.cells
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, nx + 1) * spec.size[0], np.linspace(-0.5, 0.5, ny + 1) * spec.size[1])
    faces = []
    for j in range(ny):
        for i in range(nx):
            a = j * (nx + 1) + i
            b, c, d = a + 1, a + nx + 1, a + nx + 2
            faces += [(a, b, d), (a, d, c)] if (i + j) % 2 else [(a, b, c), (b, d, c)]
    cloth = GownSpec(
        name=spec.name,
        spacing=spec.spacing,
        mass=spec.mass,
        elastic=spec.elastic,
        bending=spec.bending,
        damping=spec.damping,
        friction=spec.friction,
    )
    none = np.zeros(0, dtype=int)
    return GownMesh(
        spec=cloth,
        vertices=np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1),
        faces=np.array(faces),
        labels=np.full(len(faces), FABRIC),
        loops={},
        collar=none,
        corners=(0, 0),
        front=none,
        stays=np.zeros((0, 3), dtype=int),
    )


def placed(spec: Sheet, vertices: np.ndarray) -> np.ndarray:
    """(V, 3) where the vertices of a sheet's mesh start in the map [m]."""
    local = vertices
    if spec.hung_by is not None:
        across, up = vertices[:, 0], -vertices[:, 1]
        at = (spec.hung_by[0] - 0.5) * spec.size[0], (0.5 - spec.hung_by[1]) * spec.size[1]
        local = np.column_stack((across - at[0], np.zeros(len(vertices)), up - at[1]))
    c, s = math.cos(spec.yaw), math.sin(spec.yaw)
    return local @ np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0))).T + spec.position_in_map
