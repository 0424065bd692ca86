"""What the search may try on a cloth: each effect at a first guess, with the step that makes it matter."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....sim.effects.cloth.adhesion import surface
from ....sim.effects.cloth.proxy_bodies import spread_vertices
from ....sim.effects.model_file import EffectEntry
from .fitting import ClothModel, Free
from .scene import ClothEpisode, ClothScene

MOMENT = 0.02  # [s] by which the instant of a slip is moved in a fit
PULL = 0.3  # [N/m] of a snag: a cloth weighs a newton or two
PATCHES = 7  # places of the cloth where a mass or a snag is tried
ONSETS = (0.01, 0.03, 0.06)  # strains tried as the ones from which cloth stiffens; between them a fit finds its way [1]


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """One hypothesis.

    Attributes:
        name: effect, or the physics parameter it recalibrates.
        target: what it acts on.
        start: the model with the effect at zero size.
        push: the same at a size that should show.
        steps: finite-difference step of each free parameter.
        recalibration: one of the model's own numbers.
        power: with which the force grows with sizes above 1; screening scales forces.
    """

    name: str
    target: str
    start: ClothModel
    push: ClothModel
    steps: dict[Free, float]
    recalibration: bool = False
    power: float = 1.0


def _effect(name: str, target: str, zero: dict[str, float], push: dict[str, float], free: tuple[str, ...]) -> Candidate:
    steps: dict[Free, float] = {(name, p): (push[p] - zero[p]) if push[p] != zero[p] else 0.05 for p in free}
    keys = tuple((name, p) for p in free)
    return Candidate(
        name=name,
        target=target,
        steps=steps,
        start=ClothModel(effects=(EffectEntry(name=name, target=target, parameters=zero),), free=keys),
        push=ClothModel(effects=(EffectEntry(name=name, target=target, parameters=push),), free=keys),
    )


def candidates(scene: ClothScene, episodes: list[ClothEpisode], residuals: list[np.ndarray]) -> list[Candidate]:
    """Every hypothesis for this scene, places and times taken from where the residual is.

    Args:
        scene: the cloth.
        episodes: recordings.
        residuals: of the model so far with proxy bodies on the cloth, as every local effect brings them.
    """
    marker, t0 = _onset(scene, episodes, residuals)
    end = float(max(e.t[-1] for e in episodes))
    places = [_place(p) for p in scene.vertices[spread_vertices(scene.vertices, PATCHES, set())]]
    worst = _place(_worst_place(scene, residuals))
    out = [*_everywhere(), *_recalibrations(scene)]
    if len(scene.capsules) and _touches(scene, episodes):
        out.append(_effect("contact_friction", "cloth", {"change": 0.0}, {"change": 0.3}, ("change",)))
        out.append(_effect("adhesion", "cloth", {"pressure": 0.0}, {"pressure": 8.0}, ("pressure",)))
    out += _added_masses(scene, [*places, worst])
    out += _snags([_place(scene.vertices[scene.markers[marker]]), worst], places, t0, end)
    if any(e.pins for e in episodes):
        out += _grip_slips(t0, end)
    return out


def is_moment(c: Candidate) -> bool:
    """Whether a hypothesis is an instant and has no size."""
    return c.name == "grip_slip"


def clash(name: str, taken: set[str]) -> bool:
    """Whether a hypothesis and one of those taken are the same load."""
    return (name == "added_mass" and "mass" in taken) or (name == "mass" and "added_mass" in taken)


def _place(p: np.ndarray) -> dict[str, float]:
    return {a: float(x) for a, x in zip("xyz", p, strict=True)}


def _everywhere() -> list[Candidate]:
    """Effects that act on the whole cloth or on the reading."""
    return [
        _effect("air_drag", "cloth", {"coefficient": 0.0}, {"coefficient": 1.0}, ("coefficient",)),
        *(
            _effect(
                "strain_stiffening",
                "cloth",
                {"stiffness": 0.0, "onset": onset},
                {"stiffness": 20.0, "onset": onset},
                ("stiffness",),
            )
            for onset in ONSETS
        ),
        _effect("delay", "cloth", {"time": 0.0}, {"time": 0.01}, ("time",)),
        _effect("offset", "cloth", {a: 0.0 for a in "xyz"}, {a: 0.003 for a in "xyz"}, ("x", "y", "z")),
        _effect(
            "tilted_gravity",
            "cloth",
            {"towards_x": 0.0, "towards_y": 0.0},
            {"towards_x": 0.03, "towards_y": 0.03},
            ("towards_x", "towards_y"),
        ),
        # from almost still air, which brakes too, so that screening sees what the draught itself does
        replace(_effect("wind", "cloth", {"x": 1e-3, "y": 0.0}, {"x": 1.0, "y": 1.0}, ("x", "y")), power=2.0),
    ]


def _recalibrations(scene: ClothScene) -> list[Candidate]:
    """The model's own numbers, a quarter larger."""
    out = []
    for key in ("elastic_stiffness", "damping_stiffness", "bending_stiffness", "mass"):
        value = getattr(scene.physics, key)
        if value > 0:
            free = (("physics", key),)
            out.append(
                Candidate(
                    name=key,
                    target="cloth",
                    recalibration=True,
                    steps={free[0]: 0.25 * value},
                    start=ClothModel(physics={key: value}, free=free),
                    push=ClothModel(physics={key: 1.25 * value}, free=free),
                )
            )
    return out


def _added_masses(scene: ClothScene, places: list[dict[str, float]]) -> list[Candidate]:
    """A tenth of the cloth's mass at each place, over a fifth of its size."""
    radius = 0.2 * float(np.ptp(scene.vertices, axis=0).max())
    return [
        _effect(
            "added_mass",
            "region",
            {"mass": 0.0, **place, "radius": radius},
            {"mass": 0.1 * scene.physics.mass, **place, "radius": radius},
            ("mass",),
        )
        for place in places
    ]


def _snags(likely: list[dict[str, float]], others: list[dict[str, float]], t0: float, end: float) -> list[Candidate]:
    """A catch at each place from `t0` on: for a short and a long while where it is likely, else for a long one."""
    short, long = t0 + 0.25 * (end - t0), t0 + 0.6 * (end - t0)
    out = []
    for place, t1 in [(p, t1) for p in likely for t1 in (short, long)] + [(p, long) for p in others]:
        span = {**place, "t0": t0, "t1": t1}
        out.append(_effect("snag", "region", {"stiffness": 0.0, **span}, {"stiffness": PULL, **span}, ("stiffness",)))
    return out


def _grip_slips(t0: float, end: float) -> list[Candidate]:
    """The first pin lets go when the residual begins, or at one of four instants over the recording."""
    out = []
    for t in sorted({round(t0, 3), *(round(x, 3) for x in np.linspace(0.1, 0.8, 4) * end)}):
        slip = _effect("grip_slip", "pin 1", {"time": end + 1.0}, {"time": float(t)}, ("time",))
        out.append(replace(slip, steps={("grip_slip", "time"): MOMENT}))
    return out


def _touches(scene: ClothScene, episodes: list[ClothEpisode]) -> bool:
    return any(surface(e.markers.reshape(-1, 3), scene.capsules)[0].min() < 0.06 for e in episodes)


def _worst_place(scene: ClothScene, residuals: list[np.ndarray]) -> np.ndarray:
    """Start place of the marker whose residual is largest, (3,)."""
    m = len(scene.markers)
    energy = sum(np.sum(r[:, : 3 * m] ** 2, axis=0).reshape(m, 3).sum(axis=1) for r in residuals)
    return scene.vertices[scene.markers[int(np.argmax(energy))]]


def _onset(scene: ClothScene, episodes: list[ClothEpisode], residuals: list[np.ndarray]) -> tuple[int, float]:
    """Marker that leaves the model first, and when [s], from the episodes taken together."""
    m = len(scene.markers)
    end = float(min(e.t[-1] for e in episodes))
    grid = np.linspace(0.0, end, 90)
    energy = np.zeros((len(grid), m))
    for e, r in zip(episodes, residuals, strict=True):
        own = (r[:, : 3 * m] ** 2).reshape(len(r), m, 3).sum(axis=2)
        energy += np.stack([np.interp(grid, e.t, column) for column in own.T], axis=1)
    smooth = np.stack([np.convolve(c, np.ones(5) / 5.0, mode="same") for c in energy.T], axis=1)
    quiet = float(np.median(smooth[2:10]))
    over = smooth > 5.0 * quiet + 0.01 * float(smooth.max())
    first = np.where(over.any(axis=0), np.argmax(over, axis=0), len(grid))
    soonest = int(first.min())
    if soonest >= len(grid):
        return 0, 0.0
    later = min(soonest + 6, len(grid) - 1)
    marker = int(np.argmax(smooth[later]))
    return marker, max(0.0, float(grid[soonest]) - 0.04)
