"""Meshes of simple solids for the simulated cameras: vertices (n, 3) [m] and outward-wound faces (m, 3)."""

from __future__ import annotations

import numpy as np

Mesh = tuple[np.ndarray, np.ndarray]


def box_mesh(lower: np.ndarray, upper: np.ndarray) -> Mesh:
    """Axis-aligned box between two corners (3,); corners are split so that its edges stay sharp."""
    lower, upper = np.asarray(lower, dtype=float), np.asarray(upper, dtype=float)
    vertices, faces = [], []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for positive in (True, False):
            quad = []
            for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = np.empty(3)
                corner[axis] = upper[axis] if positive else lower[axis]
                corner[u] = upper[u] if du else lower[u]
                corner[v] = upper[v] if dv else lower[v]
                quad.append(corner)
            n = len(vertices)
            vertices += quad
            faces += [(n, n + 1, n + 2), (n, n + 2, n + 3)] if positive else [(n, n + 2, n + 1), (n, n + 3, n + 2)]
    return np.array(vertices), np.array(faces)


def sphere_mesh(centre: np.ndarray, radius: float, sides: int = 12) -> Mesh:
    """A ball of `sides` meridians."""
    return capsule_mesh(centre, centre, radius, sides)


def capsule_mesh(start: np.ndarray, end: np.ndarray, radius: float, sides: int = 12) -> Mesh:
    """All points within `radius` [m] of the segment between `start` and `end` (3,)."""
    quarter = max(2, sides // 4)
    low = np.linspace(-np.pi / 2, 0, quarter + 1)
    high = np.linspace(0, np.pi / 2, quarter + 1)
    profile = [(np.cos(t), np.sin(t), 0.0) for t in low] + [(np.cos(t), np.sin(t), 1.0) for t in high]
    return _turned(start, end, [(radius * r, radius * a, s) for r, a, s in profile], sides)


def cylinder_mesh(start: np.ndarray, end: np.ndarray, radius: float, sides: int = 12) -> Mesh:
    """A closed cylinder between the centres of its two discs (3,)."""
    profile = [
        (0.0, 0.0, 0.0),
        (radius, 0.0, 0.0),
        (radius, 0.0, 0.0),
        (radius, 0.0, 1.0),
        (radius, 0.0, 1.0),
        (0.0, 0.0, 1.0),
    ]  # doubled rims keep the edges sharp
    return _turned(start, end, profile, sides)


def loft_mesh(start: np.ndarray, end: np.ndarray, shares: np.ndarray, radii: np.ndarray, sides: int = 16) -> Mesh:
    """An open tube whose radius [m] is `radii` (n,) at the `shares` (n,) of the way between `start` and `end` (3,)."""
    profile = [(float(r), 0.0, float(s)) for r, s in zip(radii, shares, strict=True)]
    return _turned(start, end, profile, sides)


def ellipsoid_mesh(centre: np.ndarray, half_axes: np.ndarray, sides: int = 16) -> Mesh:
    """An ellipsoid with its axes along x, y and z."""
    vertices, faces = sphere_mesh(np.zeros(3), 1.0, sides)
    return vertices * half_axes + centre, faces


def _turned(start: np.ndarray, end: np.ndarray, profile: list[tuple[float, float, float]], sides: int) -> Mesh:
    """Turn a profile of (radius, offset along the axis [m], share of the axis) around start-end."""
    start, end = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    axis = end - start
    length = float(np.linalg.norm(axis))
    unit = axis / length if length > 1e-9 else np.array((0.0, 0.0, 1.0))
    helper = np.eye(3)[int(np.argmin(np.abs(unit)))]
    first = np.cross(unit, helper)
    first /= np.linalg.norm(first)
    second = np.cross(unit, first)
    angles = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    around = np.cos(angles)[:, None] * first + np.sin(angles)[:, None] * second
    vertices = np.vstack([start + s * axis + a * unit + r * around for r, a, s in profile])
    faces = []
    for ring in range(len(profile) - 1):
        for k in range(sides):
            a, b = ring * sides + k, ring * sides + (k + 1) % sides
            c, d = a + sides, b + sides
            faces += [(a, b, d), (a, d, c)]
    return vertices, np.array(faces)


def join_meshes(meshes: list[Mesh]) -> Mesh:
    """Several meshes as one."""
    offsets = np.cumsum([0] + [len(v) for v, _ in meshes[:-1]])
    return np.vstack([v for v, _ in meshes]), np.vstack([f + o for (_, f), o in zip(meshes, offsets, strict=True)])
