"""Triangle meshes in OBJ files, read strictly: PyBullet hangs on a bad one.

Triangles after a line `g stays` are springs alone, as a garment's seams and tapes: no air acts on them.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .errors import CaretreeError

MAX_VERTICES = 8192  # vertices a PyBullet soft body takes on every platform


def read_obj(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices (V, 3) [m], triangles (F, 3) and stays (S, 3); polygons are split into fans.

    Raises:
        CaretreeError: the file is missing, empty, too large or names vertices that do not exist.
    """
    if not path.is_file():
        raise CaretreeError(f"{path}: no such file")
    vertices: list[list[float]] = []
    faces: list[list[int]] = []
    stays: list[list[int]] = []
    group = faces
    for row, line in enumerate(path.read_text(errors="replace").splitlines(), start=1):
        parts = line.split()
        try:
            if parts[:1] == ["v"]:
                vertices.append([float(x) for x in parts[1:4]])
            elif parts[:1] == ["g"]:
                group = stays if parts[1:] == ["stays"] else faces
            elif parts[:1] == ["f"]:
                group += _fan(parts[1:], len(vertices))
        except (ValueError, IndexError):
            raise CaretreeError(f"{path}: row {row} is '{line[:40]}', not a vertex or a face") from None
    if not vertices or not faces:
        raise CaretreeError(f"{path}: the mesh is empty ({len(vertices)} vertices, {len(faces)} faces)")
    v, f = np.array(vertices, dtype=float), np.array(faces, dtype=int)
    s = np.array(stays, dtype=int).reshape(-1, 3)
    _check_mesh(path, v, np.vstack([f, s]))
    return v, f, s


def _fan(corners: list[str], vertices: int) -> list[list[int]]:
    """Triangles of one polygon from its corners as written: `vertex/texture/normal`, from 1 on or back from the end."""
    ids = [int(c.split("/")[0]) for c in corners]
    ids = [i - 1 if i > 0 else vertices + i for i in ids]
    return [[ids[0], ids[k], ids[k + 1]] for k in range(1, len(ids) - 1)]


def _check_mesh(path: Path, v: np.ndarray, triangles: np.ndarray) -> None:
    if v.shape[1:] != (3,) or not np.isfinite(v).all():
        raise CaretreeError(f"{path}: vertices need three finite coordinates")
    if triangles.min() < 0 or triangles.max() >= len(v):
        raise CaretreeError(f"{path}: a face names vertex {int(triangles.max()) + 1}, there are {len(v)}")
    if len(v) > MAX_VERTICES:
        raise CaretreeError(f"{path}: {len(v)} vertices, at most {MAX_VERTICES} can be simulated")
    if np.ptp(v, axis=0).max() > 20.0:
        raise CaretreeError(f"{path}: the mesh is {np.ptp(v, axis=0).max():.3g} long, it must be in metres")
    if len(np.unique(triangles)) != len(v):
        raise CaretreeError(f"{path}: {len(v) - len(np.unique(triangles))} vertices belong to no face, remove them")


def write_obj(path: Path, vertices: np.ndarray, faces: np.ndarray, stays: np.ndarray | None = None) -> None:
    """Write a mesh as PyBullet reads it; stays, where there are some, in a group of their own."""
    lines = ["v {:.9f} {:.9f} {:.9f}\n".format(*v) for v in vertices]
    lines += ["f {} {} {}\n".format(*(f + 1)) for f in faces]
    if stays is not None and len(stays):
        lines += ["g stays\n", *("f {} {} {}\n".format(*(f + 1)) for f in stays)]
    path.write_text("".join(lines))
