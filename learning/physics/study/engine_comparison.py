"""How far the two engines of `render_clip` differ, and what a clip costs with each."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np

from ....sim.scene.gown import GOWNS
from ..clips.camera import standard_camera
from ..clips.clip import packed
from ..clips.parameters import NAMES, to_spec
from ..clips.render_clip import render_clip
from ..engine.bullet import bullet_fall
from ..engine.fall import CLAMP_MASS, cut_of, fall, rest


@dataclass(frozen=True, kw_only=True)
class Difference:
    """Between the two engines, over gowns from the whole range.

    Attributes:
        what: in which setting.
        mean: of the distance between the same vertex of both, last frame, median gown [mm].
        worst: largest over vertices and frames, median gown [mm].
        depth: median absolute difference of the depth, median gown [mm].
    """

    what: str
    mean: float
    worst: float
    depth: float


def differences(gowns: int = 6, seed: int = 0) -> list[Difference]:
    """Without air and clamp, where both solve the same equations; with the clamp; and as clips are made."""
    settings = {"no air, no clamp": (False, 0.0), "no air": (False, CLAMP_MASS), "as rendered": (True, CLAMP_MASS)}
    camera, mesh = standard_camera(), cut_of(GOWNS["medium"])[0]
    found = []
    for what, (air, clamp) in settings.items():
        rows = []
        for number in range(gowns):
            unit = np.random.default_rng([seed, 12, number]).uniform(0.3, 0.9, len(NAMES))
            spec = to_spec(unit, GOWNS["medium"])
            spec = spec if air else replace(spec, air_drag=0.0)
            start = rest(spec)
            mine, theirs = fall(spec, start, clamp=clamp), bullet_fall(spec, start, clamp=clamp)
            apart = np.linalg.norm(mine - theirs, axis=2)
            depth = [np.abs(camera.look(mesh, a) - camera.look(mesh, b)) for a, b in zip(mine, theirs, strict=True)]
            rows.append((apart[-1].mean(), apart.max(), np.nanmedian(depth[1:])))
        mean, worst, depth_median = 1e3 * np.median(rows, axis=0)
        found.append(Difference(what=what, mean=float(mean), worst=float(worst), depth=float(depth_median)))
    return found


def costs(gowns: int = 20, seed: int = 0) -> dict[str, float]:
    """Processor time of the parts of a clip, mean over gowns from the whole range [ms]."""
    camera, mesh = standard_camera(), cut_of(GOWNS["medium"])[0]
    render_clip(to_spec(np.full(len(NAMES), 0.5), GOWNS["medium"]))  # compiled before the clock starts
    spent: dict[str, float] = dict.fromkeys(("static equilibrium", "fall", "15 depth pictures", "packing"), 0.0)
    for number in range(gowns):
        unit = np.random.default_rng([seed, 13, number]).random(len(NAMES))
        spec = to_spec(unit, GOWNS["medium"])
        marks = [time.process_time()]
        start = rest(spec)
        marks.append(time.process_time())
        path = fall(spec, start)
        marks.append(time.process_time())
        depth = np.array([camera.look(mesh, x) for x in path])
        marks.append(time.process_time())
        packed(depth)
        marks.append(time.process_time())
        for part, took in zip(spent, np.diff(marks), strict=True):
            spent[part] += 1e3 * took / gowns
    return spent


def report() -> str:
    """Both as Markdown."""
    lines = [
        "| engines differ | vertices, mean of the last frame [mm] | vertices, worst [mm] | depth, median [mm] |",
        "|---|---|---|---|",
    ]
    lines += [f"| {one.what} | {one.mean:.2f} | {one.worst:.1f} | {one.depth:.2f} |" for one in differences()]
    spent = costs()
    lines += ["", "| part of a clip | processor time [ms] |", "|---|---|"]
    lines += [f"| {part} | {took:.1f} |" for part, took in spent.items()]
    lines += [f"| together | {sum(spent.values()):.1f} |"]
    return "\n".join(lines)
