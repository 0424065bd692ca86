"""Is the motion of the gown one that cloth could make?  Stretch, speed and depth, a few frames at a time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

CHUNK = 64  # frames held in double precision at once


def edges_of(faces: np.ndarray) -> np.ndarray:
    """(E, 2) undirected edges of (F, 3) triangles, each once."""
    pairs = np.concatenate([faces[:, [k, (k + 1) % 3]] for k in range(3)])
    return np.unique(np.sort(pairs, axis=1), axis=0)


@dataclass(frozen=True, kw_only=True)
class Motion:
    """What the gown did, frame by frame.

    Attributes:
        stretch_p99: (T,) 99th percentile of edge length over rest length.
        stretch_max: (T,) longest edge over its rest length.
        speed: (T,) of the fastest vertex since the frame before [m/s]; 0 in the first.
        depth: (T,) of the deepest vertex below the skin of an arm [m]; 0 where none is.
    """

    stretch_p99: np.ndarray
    stretch_max: np.ndarray
    speed: np.ndarray
    depth: np.ndarray


def depth_inside(vertices: np.ndarray, start: np.ndarray, end: np.ndarray, radius: float) -> np.ndarray:
    """Depth of the deepest vertex inside a capsule.

    Args:
        vertices: (T, V, 3) [m].
        start: (T, 3) one end of the capsule's axis [m].
        end: (T, 3) the other end [m].
        radius: [m].

    Returns:
        (T,) [m], 0 where no vertex is inside.
    """
    axis = (end - start)[:, None]
    seen = vertices - start[:, None]
    length_squared = np.einsum("tki,tki->tk", axis, axis) + 1e-12
    along = np.clip(np.einsum("tvi,tki->tv", seen, axis) / length_squared, 0.0, 1.0)
    off = seen - along[..., None] * axis
    nearest = np.sqrt(np.einsum("tvi,tvi->tv", off, off).min(axis=1))
    return np.maximum(radius - nearest, 0.0)


def motion(
    t: np.ndarray, vertices: np.ndarray, faces: np.ndarray, rest: np.ndarray, arms: np.ndarray, radii: np.ndarray
) -> Motion:
    """Measure a whole run.

    Args:
        t: (T,) [s].
        vertices: (T, V, 3) [m], finite.
        faces: (F, 3).
        rest: (V, 3) rest shape [m].
        arms: (T, 2, 4, 3) [m].
        radii: (2, 3) [m].
    """
    count = len(t)
    p99, longest, speed, depth = (np.zeros(count) for _ in range(4))
    edges = edges_of(faces)
    rest = rest.astype(np.float64)
    rest_length = np.maximum(np.linalg.norm(rest[edges[:, 0]] - rest[edges[:, 1]], axis=1), 1e-9)
    before: np.ndarray | None = None
    for first in range(0, count, CHUNK):
        part = slice(first, min(first + CHUNK, count))
        now = vertices[part].astype(np.float64)
        ratio = np.linalg.norm(now[:, edges[:, 0]] - now[:, edges[:, 1]], axis=2) / rest_length
        p99[part], longest[part] = np.percentile(ratio, 99, axis=1), ratio.max(axis=1)
        path = now if before is None else np.concatenate([before[None], now])
        step = np.linalg.norm(np.diff(path, axis=0), axis=2).max(axis=1)
        times = t[part.stop - len(path) : part.stop]
        speed[part.stop - len(step) : part.stop] = step / np.maximum(np.diff(times), 1e-9)
        before = now[-1]
        for arm in range(2):
            points = arms[part, arm].astype(np.float64)
            for k in range(3):
                inside = depth_inside(now, points[:, k], points[:, k + 1], float(radii[arm, k]))
                depth[part] = np.maximum(depth[part], inside)
    return Motion(stretch_p99=p99, stretch_max=longest, speed=speed, depth=depth)
