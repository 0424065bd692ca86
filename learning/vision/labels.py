"""What a picture shows, from the truth: surface of every pixel, place on the gown's sheet, key points.

The renderer is asked once more with a number of its own for every face; what face a pixel shows says the rest.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...sim.render.camera import CLOTH_ID, Renderer
from ...sim.render.raster import Triangles, rasterise
from ...sim.scene.gown import ARMHOLE, COLLAR, CUFF, GownMesh
from ...sim.world import SIDES

SURFACES = ("other", "outside", "inside", "collar", "armhole", "cuff", "skin")
OTHER, OUTSIDE, INSIDE, _COLLAR, _ARMHOLE, _CUFF, SKIN = range(len(SURFACES))
_BINDINGS = {COLLAR: _COLLAR, ARMHOLE: _ARMHOLE, CUFF: _CUFF}
JOINTS = ("shoulder", "elbow", "wrist", "fingertip")
KEY_POINTS = (
    *(f"{what}_{side}" for what in ("corner", "strap", "armhole", "cuff") for side in SIDES),
    "hook",
    *(f"{joint}_{side}" for side in SIDES for joint in JOINTS),
)
ABSENT, HIDDEN, SHOWN = range(3)  # of a key point: out of the picture; behind something; in free view
# How far [m] the surface in front of a key point may be nearer than the point for it to count as shown: what lies on
# the cloth, the middle of an opening, a joint inside its arm.
_SLACK = {"corner": 0.02, "strap": 0.02, "armhole": 0.10, "cuff": 0.10, "hook": 0.03}
_JOINT_SLACK = 0.05


@dataclass(frozen=True, kw_only=True)
class Labels:
    """The truth about one picture.

    Attributes:
        surface: (H, W) uint8, index in `SURFACES`.
        sheet: (H, W, 3) float32, place of a gown pixel in the gown's rest shape [m], NaN elsewhere.
        points: (K, 3) float32, u, v [px] and depth [m] of every one of `KEY_POINTS`.
        points_in_map: (K, 3) float32 [m].
        seen: (K,) uint8, `ABSENT`, `HIDDEN` or `SHOWN`.
    """

    surface: np.ndarray
    sheet: np.ndarray
    points: np.ndarray
    points_in_map: np.ndarray
    seen: np.ndarray


def strap_weights(mesh: GownMesh, side: str) -> np.ndarray:
    """(V,) weights of the vertices whose mean is the middle of the strap above an armhole."""
    spec, loop = mesh.spec, mesh.vertices[mesh.loops[f"armhole_{side}"]]
    middle = (loop[:, 0].min() + loop[:, 0].max()) / 2
    level = -spec.strap * spec.spacing / 2
    offset = np.abs(mesh.vertices - (middle, 0.0, level)) / spec.spacing
    weights = np.clip(1.0 - offset, 0.0, None).prod(axis=1)  # bilinear between the grid's corners
    return weights / weights.sum()


def key_points(mesh: GownMesh, vertices: np.ndarray, arms: np.ndarray, hook: np.ndarray) -> np.ndarray:
    """(K, 3) where `KEY_POINTS` are in the map [m], hidden or not.

    Args:
        mesh: of the gown.
        vertices: (V, 3) where they are [m].
        arms: (2, 4, 3) of the person [m].
        hook: (3,) [m].
    """
    places = [vertices[corner] for corner in mesh.corners]
    places += [strap_weights(mesh, side) @ vertices for side in SIDES]
    places += [vertices[mesh.loops[f"{what}_{side}"]].mean(axis=0) for what in ("armhole", "cuff") for side in SIDES]
    return np.vstack([*places, hook, arms.reshape(-1, 3)])


def label(
    renderer: Renderer,
    mesh: GownMesh,
    arms: np.ndarray,
    hook: np.ndarray | None,
    pose_camera_in_map: np.ndarray,
    intrinsics: tuple[float, float, float, float],
    size: tuple[int, int],
    gown: bool = True,
) -> Labels:
    """Label a picture that `renderer` would draw.

    Args:
        renderer: the room as it is.
        mesh: of the gown in it.
        arms: (2, 4, 3) of the person [m].
        hook: (3,) where the gown hangs [m]; None where it does not.
        pose_camera_in_map: (4, 4), optical frame.
        intrinsics: (fx, fy, cx, cy) [px].
        size: (width, height) [px].
        gown: whether it is in the room.
    """
    scene = renderer.triangles()
    faces = np.arange(len(scene.faces), dtype=np.int32)
    picture = rasterise(replace(scene, ids=faces), renderer.light, intrinsics, pose_camera_in_map, size)
    drawn, owner = picture.ids >= 0, np.maximum(picture.ids, 0)
    cloth = drawn & (scene.ids[owner] == CLOTH_ID)
    skin = [number for name, number in renderer.ids.items() if _is_skin(name)]
    surface = np.where(drawn & np.isin(scene.ids[owner], skin), SKIN, OTHER).astype(np.uint8)
    sheet = np.full((*picture.depth.shape, 3), np.nan, np.float32)
    if cloth.any():
        surface[cloth], sheet[cloth] = _on_cloth(
            scene, owner, cloth, mesh, picture.depth, pose_camera_in_map, intrinsics
        )
    vertices = scene.vertices[len(scene.vertices) - len(mesh.vertices) :] if gown else mesh.vertices
    there = key_points(mesh, vertices, arms, np.zeros(3) if hook is None else hook)
    points, seen = _in_picture(there, picture.depth, pose_camera_in_map, intrinsics)
    if hook is None:
        seen[KEY_POINTS.index("hook")] = ABSENT
    if not gown:
        seen[: len(KEY_POINTS) - 2 * len(JOINTS)] = ABSENT
    return Labels(
        surface=surface,
        sheet=sheet,
        points=points.astype(np.float32),
        points_in_map=there.astype(np.float32),
        seen=seen,
    )


def _is_skin(body: str) -> bool:
    return body.startswith(("trunk", "neck", "arm", "shoulder")) or body.endswith("_shin")


def _on_cloth(
    scene: Triangles,
    owner: np.ndarray,
    cloth: np.ndarray,
    mesh: GownMesh,
    depth: np.ndarray,
    pose: np.ndarray,
    intrinsics: tuple[float, float, float, float],
) -> tuple[np.ndarray, np.ndarray]:
    """Surface (n,) and place in the rest shape (n, 3) of the pixels of the gown."""
    rows, columns = np.nonzero(cloth)
    fx, fy, cx, cy = intrinsics
    z = depth[cloth].astype(float)
    there = np.column_stack([(columns - cx) / fx * z, (rows - cy) / fy * z, z]) @ pose[:3, :3].T + pose[:3, 3]
    shown = owner[cloth]
    a, b, c = (scene.vertices[scene.faces[shown, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    area = (normal**2).sum(axis=1) + 1e-18
    wb = (np.cross(there - a, c - a) * normal).sum(axis=1) / area
    wc = (np.cross(b - a, there - a) * normal).sum(axis=1) / area
    first = len(scene.faces) - len(mesh.faces)
    ra, rb, rc = (mesh.vertices[mesh.faces[shown - first, k]] for k in range(3))
    sheet = (1 - wb - wc)[:, None] * ra + wb[:, None] * rb + wc[:, None] * rc
    outside = (normal * (pose[:3, 3] - a)).sum(axis=1) > 0
    surface = np.where(outside, OUTSIDE, INSIDE)
    for label_of_face, binding in _BINDINGS.items():
        surface[mesh.labels[shown - first] == label_of_face] = binding
    return surface.astype(np.uint8), sheet.astype(np.float32)


def _in_picture(
    there: np.ndarray, depth: np.ndarray, pose: np.ndarray, intrinsics: tuple[float, float, float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """(K, 3) u, v [px] and depth [m], and (K,) how the points are seen."""
    fx, fy, cx, cy = intrinsics
    local = (there - pose[:3, 3]) @ pose[:3, :3]
    z = np.maximum(local[:, 2], 1e-3)
    points = np.column_stack([fx * local[:, 0] / z + cx, fy * local[:, 1] / z + cy, local[:, 2]])
    height, width = depth.shape
    inside = (local[:, 2] > 0.05) & (points[:, 0] >= 0) & (points[:, 0] <= width - 1)
    inside &= (points[:, 1] >= 0) & (points[:, 1] <= height - 1)
    columns = np.where(inside, np.round(points[:, 0]), 0).astype(int)
    rows = np.where(inside, np.round(points[:, 1]), 0).astype(int)
    slack = np.array([_SLACK.get(name.split("_")[0], _JOINT_SLACK) for name in KEY_POINTS])
    before = np.where(depth[rows, columns] > 0, depth[rows, columns], np.inf)
    # a corner is where the cloth ends: its own pixel may be the background's
    free = before > points[:, 2] - slack
    return points, np.where(~inside, ABSENT, np.where(free, SHOWN, HIDDEN)).astype(np.uint8)
