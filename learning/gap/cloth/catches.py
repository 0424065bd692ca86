"""Where on the cloth a snag caught, from when and until when.

Places are tried, then spans of time, each at the size one simulation says it wants; then size and instants are fitted
together.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....sim.effects.cloth.proxy_bodies import proxy_count, spread_vertices
from ....sim.effects.model_file import EffectEntry
from .fitting import ClothFit, ClothFitter, ClothModel, Free
from .scene import ClothScene

NAME = "snag"
SIZE: Free = (NAME, "stiffness")
PLACES = 16  # nearest parts of the cloth that are tried
INSTANTS = 6  # a recording is cut into so many parts to look for the span in
MOMENT = 0.05  # finite difference of the instants, over a recording's length
FINE = 2e-4  # a weak long catch and a strong short one are nearly the same: fitted until it stands still
WEAKEST = 0.3  # [N/m]; a weaker guess would make no difference to compare


def best_catch(fitter: ClothFitter, fit: ClothFit, scene: ClothScene, steps: dict[Free, float]) -> ClothFit:
    """Move the snag of a fit to where and when it explains most.

    Args:
        fitter: of the recordings.
        fit: a fit with a snag.
        scene: the cloth.
        steps: of the free parameters.
    """
    held = {i for e in fitter.episodes for pin in e.pins for i in pin.vertices}
    parts = scene.vertices[spread_vertices(scene.vertices, proxy_count(len(scene.vertices)), held)]
    end = float(max(e.t[-1] for e in fitter.episodes))
    model = _place(fitter, fit.model, parts)
    model = _span(fitter, model, end)
    fit = _fitted(fitter, fit, model, steps, end)
    again = _place(fitter, fit.model, parts)
    if _where(again) != _where(fit.model):
        fit = _fitted(fitter, fit, again, steps, end)
    return fit


def _fitted(fitter: ClothFitter, fit: ClothFit, model: ClothModel, steps: dict[Free, float], end: float) -> ClothFit:
    """The better of a fit and of a model with its size and instants fitted."""
    free = (*model.free, (NAME, "t0"), (NAME, "t1"))
    timed = fitter.fit(
        replace(model, free=free),
        {**steps, (NAME, "t0"): MOMENT * end, (NAME, "t1"): MOMENT * end},
        rounds=8,
        least=FINE,
    )
    return replace(timed, model=replace(timed.model, free=model.free)) if timed.rss < fit.rss else fit


def _entry(model: ClothModel) -> EffectEntry:
    return next(e for e in model.effects if e.name == NAME)


def _where(model: ClothModel) -> tuple[float, ...]:
    return tuple(_entry(model).parameters[a] for a in "xyz")


def _with(model: ClothModel, **changes: float) -> ClothModel:
    values = {**_entry(model).parameters, **changes}
    moved = EffectEntry(name=NAME, target=_entry(model).target, parameters=values)
    return replace(model, effects=tuple(moved if e.name == NAME else e for e in model.effects))


def _best(fitter: ClothFitter, models: list[ClothModel]) -> ClothModel:
    strong = [_with(m, stiffness=max(m.value(SIZE), WEAKEST)) for m in models]
    return fitter.sized(strong, _with(models[0], stiffness=0.0), SIZE)[0][1]


def _place(fitter: ClothFitter, model: ClothModel, parts: np.ndarray) -> ClothModel:
    """The model with the snag at the part, among those near it, that explains most."""
    near = parts[np.argsort(np.linalg.norm(parts - np.array(_where(model)), axis=1))[:PLACES]]
    return _best(fitter, [_with(model, **{a: float(x) for a, x in zip("xyz", p, strict=True)}) for p in near])


def _span(fitter: ClothFitter, model: ClothModel, end: float) -> ClothModel:
    """The model with the snag in the span of time, among all between a few instants, that explains most."""
    instants = np.linspace(0.0, end, INSTANTS + 1)
    spans = [(a, b) for i, a in enumerate(instants) for b in instants[i + 1 :]]
    own = [_with(model, t1=min(_entry(model).parameters["t1"], end))]
    return _best(fitter, [*own, *(_with(model, t0=float(a), t1=float(b)) for a, b in spans)])
