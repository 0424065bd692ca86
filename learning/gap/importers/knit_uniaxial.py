"""Knitted fabric pulled between two clamps to 30 N, filmed: one set per fabric that was pulled several times.

The upper clamp is fixed and carries the load cell, the lower one is driven.  The pull takes a minute and is slow enough
for inertia not to matter, so it is replayed in `DURATION` seconds, with a mass at which the springs can be integrated
and without gravity.  The scale of the camera is not in the files; the sheet's width is taken as the 126.66 mm at which
the authors model one of their fabrics, which moves lengths and stiffness by one factor and strains not at all.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ....sim.obj_file import write_obj
from ..table import write_table
from .setting import write_set

WIDTH = 0.12666  # [m] of every fabric
DURATION = 1.0  # [s]
RATE = 60.0  # [1/s]
CELLS = 6  # across the sheet
MASS = 0.2  # [kg]; inertia of the replay stays below 0.1 N
STIFFNESS = 400.0  # [N/m] of each spring, a first guess: the knits' own is what is asked for
FABRICS = {
    "Acrylic Yarn Garter Y": "acrylic_garter_y",
    "Acrylic Yarn Stockinette Y": "acrylic_stockinette_y",
    "Pearlized Cotton Rib Y": "cotton_rib_y",
    "Pearlized Cotton Stockinette Y": "cotton_stockinette_y",
}
MOST = 4  # pulls per fabric: three to fit, one held out


def write(files: dict[str, Path], out: Path) -> list[Path]:
    """One folder per fabric; its last pull is held out."""
    import h5py

    written = []
    for title, name in FABRICS.items():
        with h5py.File(files[f"outputData_{title}.h5"], "r") as book:
            written.append(_fabric(book, out / name))
    return written


def _fabric(book: Any, folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    pulls = sorted(k for k in book if k.startswith("video"))[:MOST]
    scale = WIDTH / float(np.asarray(book["fabricSize"]).ravel()[0])  # [m] per pixel
    records = [_pull(book[k], scale) for k in pulls]
    heights = [r["bottom"][0] for r in records]
    height = float(np.median(heights))
    down = 2 * max(1, round(CELLS * height / WIDTH / 2.0))  # even: the side pins sit half way
    vertices = np.array(
        [(WIDTH * (i / CELLS - 0.5), 0.0, -height * j / down) for j in range(down + 1) for i in range(CELLS + 1)]
    )
    row = CELLS + 1
    faces = [(a, a + row, a + 1) for j in range(down) for a in range(j * row, j * row + CELLS)]
    faces += [(a + 1, a + row, a + row + 1) for j in range(down) for a in range(j * row, j * row + CELLS)]
    write_obj(folder / "sheet.obj", vertices, np.array(faces))
    middle = (down // 2) * row
    markers = [middle, middle + CELLS]  # left and right edge half way down
    top, bottom = list(range(row)), list(range(down * row, (down + 1) * row))
    episodes = []
    for k, r in enumerate(records):
        t, moved = r["t"], r["bottom"] - r["bottom"][0]
        write_table(folder / f"clamp_{k + 1}.csv", {"t": t, "x": 0.0 * t, "y": 0.0 * t, "z": -moved})
        columns = {"t": t}
        for m, (vertex, side) in enumerate(zip(markers, ("left", "right"), strict=True)):
            path = r[side] - r[side][0]  # from where its vertex starts
            columns |= {f"m{m}x": vertices[vertex][0] + path[:, 0], f"m{m}y": 0.0 * t}
            columns |= {f"m{m}z": vertices[vertex][2] - path[:, 1]}
        columns |= {"fx": 0.0 * t, "fy": 0.0 * t, "fz": -r["force"]}
        episodes.append((f"pull_{k + 1}", "heldout" if k == len(records) - 1 else "fit", columns))
    header = {
        "system": "cloth",
        "mesh": "sheet.obj",
        "physics": {
            "mass": MASS,
            "elastic_stiffness": STIFFNESS,
            "damping_stiffness": 0.02,
            "bending_stiffness": 0.0,
            "friction": 0.0,
            "gravity": 0.0,
            "time_step": 0.001,
        },
        "markers": markers,
    }
    pins = [[{"vertices": [*top]}, {"vertices": [*bottom], "path": f"clamp_{k + 1}.csv"}] for k in range(len(records))]
    return write_set(folder, header, episodes, pins)


def _pull(video: Any, scale: float) -> dict[str, np.ndarray]:
    """One pull on an even grid of replayed time: t, force, lower clamp and side pins [m] from the upper clamp.

    Points are stored right pin, left pin, ..., lower clamp, upper clamp; y grows downwards.
    """
    force = np.asarray(video["forces"], dtype=float)
    points = np.asarray(video["traj"], dtype=float) * scale  # (points, 2, frames)
    frames = np.asarray(video["frames"], dtype=float)
    since = DURATION * (frames - frames[0]) / (frames[-1] - frames[0])
    t = np.arange(0.0, DURATION + 1e-9, 1.0 / RATE)
    origin = points[-1]

    def even(series: np.ndarray) -> np.ndarray:
        smooth = np.convolve(np.pad(series, 7, mode="edge"), np.ones(15) / 15.0, mode="valid")
        return np.interp(t, since, smooth)

    def path(k: int) -> np.ndarray:
        return np.stack([even(points[k, a] - origin[a]) for a in (0, 1)], axis=1)

    sides = sorted((path(0), path(1)), key=lambda p: float(p[0, 0]))
    return {"t": t, "force": even(force), "bottom": path(-2)[:, 1], "left": sides[0], "right": sides[1]}
