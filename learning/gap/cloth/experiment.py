"""Which cloth experiment would tell two explanations apart, found by simulating both in it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....sim.effects.model_file import EffectEntry
from ..findings import told_apart
from .fitting import ClothModel
from .scene import ClothEpisode, Pin
from .simulate import Simulator

GUESS = {
    "air_drag": {"coefficient": 1.0},
    "wind": {"x": 1.0, "y": 1.0},
    "tilted_gravity": {"towards_x": 0.03, "towards_y": 0.03},
    "strain_stiffening": {"stiffness": 20.0, "onset": 0.03},
    "contact_friction": {"change": 0.3},
    "adhesion": {"pressure": 8.0},
    "delay": {"time": 0.02},
    "offset": {"x": 0.003, "y": 0.003, "z": 0.003},
}


def separating(sim: Simulator, episode: ClothEpisode, model: ClothModel, name: str, rival: str, floor: float) -> str:
    """Sentence with the experiment in which the found effect and its rival part most, the rival scaled to fit here."""
    if rival not in GUESS:
        return ""
    own = ClothModel(effects=tuple(e for e in model.effects if e.name == name), physics=model.physics)
    other = (EffectEntry(name=rival, target="cloth", parameters=GUESS[rival]),)
    plain = sim.run(episode)
    a = sim.run(episode, own.effects, own.physics) - plain
    b = sim.run(episode, other) - plain
    factor = float(np.sum(a * b) / (np.sum(b * b) + 1e-30))
    best = ("", 0.0)
    for text, changed in (
        ("hang it still for twice as long", _still(episode)),
        ("repeat the motion twice as fast", _faster(episode, 0.5)),
        ("repeat the motion at half the speed", _faster(episode, 2.0)),
    ):
        base = sim.run(changed)
        apart = sim.run(changed, own.effects, own.physics) - base - factor * (sim.run(changed, other) - base)
        size = float(np.sqrt(np.mean(apart**2)) / max(floor, 1e-9))
        if size > best[1]:
            best = (text, size)
    return told_apart(best[0], name, rival, best[1])


def _still(e: ClothEpisode) -> ClothEpisode:
    pins = tuple(Pin(vertices=p.vertices, release_t=float("inf"), path=None) for p in e.pins)
    return replace(e, name=f"{e.name} still", t=e.t * 2.0, pins=pins, load=None)


def _faster(e: ClothEpisode, stretch: float) -> ClothEpisode:
    def path(p: Pin) -> Pin:
        return p if p.path is None else replace(p, path=p.path * np.array([stretch, 1.0, 1.0, 1.0]))

    return replace(e, name=f"{e.name} x{stretch}", pins=tuple(path(p) for p in e.pins), load=None)
