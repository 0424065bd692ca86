"""Where on the cloth a mass sits: the patch whose parts together explain the residual best.

A patch is what lies within a radius of a vertex.  Each part of the cloth near the first guess is loaded alone, and what
it does is added up over the parts of a patch, so that all patches can be compared for a few simulations; the best are
then simulated themselves.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....sim.effects.cloth.proxy_bodies import proxy_count, spread_vertices
from ....sim.effects.model_file import EffectEntry
from .fitting import ClothFit, ClothFitter, ClothModel, Free, scaled_to
from .scene import ClothScene

NAME = "added_mass"
PARTS = 16  # at most so many parts of the cloth are loaded alone
SIMULATED = 12  # patches that are simulated
FITTED = 2  # and fitted


def best_patch(fitter: ClothFitter, fit: ClothFit, scene: ClothScene, steps: dict[Free, float]) -> ClothFit:
    """Move the added mass of a fit to the patch that explains most.

    Args:
        fitter: of the recordings.
        fit: a fit with an added mass.
        scene: the cloth.
        steps: of the free parameters.
    """
    entry = next(e for e in fit.model.effects if e.name == NAME)
    centre = np.array([entry.parameters[a] for a in "xyz"])
    held = {i for e in fitter.episodes for pin in e.pins for i in pin.vertices}
    parts = scene.vertices[spread_vertices(scene.vertices, proxy_count(len(scene.vertices)), held)]
    parts = parts[np.argsort(np.linalg.norm(parts - centre, axis=1))[:PARTS]]
    each = max(entry.parameters["mass"], 1e-4) / 3.0
    without = _placed(fit.model, entry, centre, 0.0, 0.0)
    loaded = [_placed(fit.model, entry, p, each, 0.0) for p in parts]
    fitter.sim.ahead([(e, m.acting, m.physics) for m in loaded for e in fitter.episodes])
    start = fitter.flat(fitter.residuals(without))
    alone = np.stack([start - fitter.flat(fitter.residuals(m)) for m in loaded], axis=1)
    ranked = []
    for place, radius, inside in _patches(scene.vertices, parts):
        left, factor = scaled_to(start, alone[:, inside].mean(axis=1))
        ranked.append((left, _placed(fit.model, entry, place, factor * each, radius)))
    ranked.sort(key=lambda x: x[0])
    best = fit
    for _, model in fitter.sized([m for _, m in ranked[:SIMULATED]], without, (NAME, "mass"))[:FITTED]:
        tried = fitter.fit(model, steps, rounds=1)
        best = tried if tried.rss < best.rss else best
    return best


def _placed(model: ClothModel, entry: EffectEntry, place: np.ndarray, mass: float, radius: float) -> ClothModel:
    where = {a: float(x) for a, x in zip("xyz", place, strict=True)}
    moved = EffectEntry(name=NAME, target=entry.target, parameters={**where, "mass": mass, "radius": radius})
    return replace(model, effects=tuple(moved if e.name == NAME else e for e in model.effects))


def _patches(vertices: np.ndarray, parts: np.ndarray) -> list[tuple[np.ndarray, float, np.ndarray]]:
    """Every different patch: its middle, a radius that draws the line half way, and the parts inside."""
    found: dict[tuple[int, ...], tuple[np.ndarray, float, np.ndarray]] = {}
    for place in vertices:
        away = np.linalg.norm(parts - place, axis=1)
        order = np.argsort(away)
        for k in range(1, len(parts) // 2 + 1):
            if away[order[k]] - away[order[k - 1]] < 1e-6:
                continue  # no circle tells these two apart
            inside = np.sort(order[:k])
            found.setdefault(tuple(inside), (place, 0.5 * float(away[order[k - 1]] + away[order[k]]), inside))
    return list(found.values())
