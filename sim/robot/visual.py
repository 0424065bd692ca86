"""What the robot looks like: a few hundred triangles per link for the project's own rasteriser.

Baxter's meshes have 4,000 to 38,000 triangles each, most of them inside.  Cut into slices along the link and
wrapped slice by slice in convex hulls, they keep their silhouette with a hundredth of that.
"""

from __future__ import annotations

import io
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from ..mechanics.robot_model import RobotModel
from ..mechanics.shape import Shape
from ..render.solids import box_mesh, capsule_mesh
from ..world import SIDES
from .baxter import BAXTER
from .shapes import BLACK, DARK, RED, STEEL, collision_shapes
from .urdf import baxter_folder, cache_folder, write_atomically

Mesh = tuple[np.ndarray, np.ndarray, tuple[float, float, float]]

_VERSION = 2  # of the cached file: raise it when the meshes change
_GRID = 0.008  # vertices closer than this are one [m]; more for a large link

# Link (without its side) -> mesh file, axis it is sliced along, slices, colour.
_BAXTER: dict[str, tuple[str, int, int, tuple[float, float, float]]] = {
    "torso": ("torso/base_link.DAE", 2, 7, DARK),
    "head": ("head/H0.DAE", 2, 1, DARK),
    "upper_shoulder": ("upper_shoulder/S0.DAE", 2, 4, RED),
    "lower_shoulder": ("lower_shoulder/S1.DAE", 2, 3, DARK),
    "upper_elbow": ("upper_elbow/E0.DAE", 2, 4, RED),
    "lower_elbow": ("lower_elbow/E1.DAE", 2, 3, DARK),
    "upper_forearm": ("upper_forearm/W0.DAE", 2, 4, RED),
    "lower_forearm": ("lower_forearm/W1.DAE", 0, 4, DARK),
    "wrist": ("wrist/W2.DAE", 2, 3, STEEL),
}
# Baxter's face is a link of its own in the source; here it turns with the head.
_SCREEN = ("head/H1.DAE", (1.75057, 0.0, np.pi / 2), (0.0, -np.pi / 2, 0.0))


def meshes_of(robot: RobotModel) -> dict[str, Mesh]:
    """Meshes of every link that shows, as `visual_meshes` has them; other robots than Baxter look as they collide."""
    return visual_meshes() if robot is BAXTER else _collision_meshes(robot)


def _collision_meshes(robot: RobotModel) -> dict[str, Mesh]:
    meshes: dict[str, Mesh] = {}
    for name, shapes in robot.shapes.items():
        rgb = next((shape.rgb for shape in shapes if shape.rgb is not None), DARK)
        meshes[name] = (*_join([_solid(shape) for shape in shapes]), rgb)
    return meshes | _cameras()


@lru_cache
def visual_meshes() -> dict[str, Mesh]:
    """Meshes of every visible link: vertices (n, 3) in the link frame [m], outward faces (m, 3), rgb from 0 to 1.

    Made once and kept in the user's cache folder.
    """
    path = cache_folder() / f"robot_visual_{_VERSION}.npz"
    meshes = _load(path) or _build()
    if not path.exists():
        stream = io.BytesIO()
        arrays: dict[str, Any] = {
            f"{name}:{part}": value
            for name, mesh in meshes.items()
            for part, value in zip(("vertices", "faces", "rgb"), mesh, strict=True)
        }
        np.savez_compressed(stream, **arrays)
        write_atomically(path, stream.getvalue())
    for name, shapes in collision_shapes().items():  # base, column, palm and fingers are drawn as they collide
        boxes = [_solid(shape) for shape in shapes if shape.rgb is not None]
        if boxes:
            rgb = next(shape.rgb for shape in shapes if shape.rgb is not None)
            meshes[name] = (*_join(boxes), rgb)
    return meshes


def _load(path: Path) -> dict[str, Mesh] | None:
    if not path.exists():
        return None
    try:
        with np.load(path) as file:
            names = {key.split(":")[0] for key in file.files}
            rgb = {name: file[f"{name}:rgb"] for name in names}
            return {
                name: (
                    file[f"{name}:vertices"],
                    file[f"{name}:faces"],
                    (float(rgb[name][0]), float(rgb[name][1]), float(rgb[name][2])),
                )
                for name in sorted(names)
            }
    except (OSError, ValueError, KeyError):  # damaged: build it again
        path.unlink(missing_ok=True)
        return None


def _build() -> dict[str, Mesh]:
    meshes: dict[str, Mesh] = {}
    for link, (file, axis, slices, rgb) in _BAXTER.items():
        hulls = _slice_hulls(*_read_mesh(file), axis, slices)
        if link == "head":
            vertices, faces = _read_mesh(_SCREEN[0])
            turn = _rotation(_SCREEN[1]) @ _rotation(_SCREEN[2])
            shift = _rotation(_SCREEN[1]) @ np.array((0.0, -0.00953, -0.0347))
            hulls = [(v + np.array((0.0, 0.0, 0.00953)), f) for v, f in hulls]
            hulls += _slice_hulls(vertices @ turn.T + shift + np.array((0.1227, 0.0, 0.0)), faces, 1, 1)
        mesh = (*_join(hulls), rgb)
        for name in (link,) if link in ("torso", "head") else tuple(f"{side}_{link}" for side in SIDES):
            meshes[name] = mesh
    return meshes | _cameras()


def _cameras() -> dict[str, Mesh]:
    hand = (*box_mesh(np.array((-0.03, -0.01, -0.02)), np.array((0.03, 0.01, 0.0))), BLACK)
    meshes: dict[str, Mesh] = {f"{side}_hand_camera": hand for side in SIDES}
    meshes["head_camera"] = (*box_mesh(np.array((-0.06, -0.015, -0.03)), np.array((0.06, 0.015, 0.0))), BLACK)
    return meshes


def _read_mesh(file: str) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of one of Baxter's Collada files, in its link frame [m]."""
    import coal  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

    mesh = coal.MeshLoader(coal.NODE_TYPE.BV_OBBRSS).load(str(baxter_folder() / "meshes" / file), np.ones(3))
    faces = [mesh.tri_indices(n) for n in range(mesh.num_tris)]
    return np.array(mesh.vertices()), np.array([(face[0], face[1], face[2]) for face in faces])


def _slice_hulls(
    vertices: np.ndarray, faces: np.ndarray, axis: int, slices: int
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Convex hulls of what lies between equally spaced planes across `axis`."""
    edges = np.linspace(vertices[:, axis].min(), vertices[:, axis].max(), slices + 1)
    points = np.concatenate((vertices, *(_cut(vertices, faces, axis, plane) for plane in edges[1:-1])))
    grid = max(_GRID, float(np.ptp(vertices, axis=0).max()) / 60.0)
    hulls = []
    for low, high in pairwise(edges):
        inside = points[(points[:, axis] >= low - 1e-6) & (points[:, axis] <= high + 1e-6)]
        hull = _hull(np.unique(np.round(inside / grid), axis=0) * grid)
        if hull is not None:
            hulls.append(hull)
    return hulls


def _cut(vertices: np.ndarray, faces: np.ndarray, axis: int, plane: float) -> np.ndarray:
    """Points (n, 3) where the edges of a mesh cross a plane."""
    ends = vertices[np.concatenate((faces[:, (0, 1)], faces[:, (1, 2)], faces[:, (2, 0)]))]
    height = ends[:, :, axis] - plane
    crossing = height[:, 0] * height[:, 1] < 0
    a, b = height[crossing, 0], height[crossing, 1]
    return ends[crossing, 0] + (a / (a - b))[:, None] * (ends[crossing, 1] - ends[crossing, 0])


def _hull(points: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    from scipy.spatial import ConvexHull, QhullError

    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):  # a flat sliver has no volume and nothing to show
        return None
    used, faces = np.unique(hull.simplices, return_inverse=True)
    faces = faces.reshape(-1, 3)
    vertices = points[used]
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return vertices, faces


def _solid(shape: Shape) -> tuple[np.ndarray, np.ndarray]:
    if shape.kind == "box":
        half = np.array(shape.size) / 2
        vertices, faces = box_mesh(-half, half)
    else:
        radius, length = shape.size
        half = np.array((0.0, 0.0, length / 2))
        vertices, faces = capsule_mesh(-half, half, radius)
    return vertices @ _rotation(shape.rpy).T + shape.xyz, faces


def _join(parts: list[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in parts[:-1])])
    return (
        np.concatenate([vertices for vertices, _ in parts]),
        np.concatenate([faces + start for (_, faces), start in zip(parts, starts, strict=True)]),
    )


def _rotation(rpy) -> np.ndarray:
    from scipy.spatial.transform import Rotation

    return Rotation.from_euler("xyz", rpy).as_matrix()
