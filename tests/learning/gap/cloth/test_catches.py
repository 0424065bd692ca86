"""A cloth that answers to a snag in proportion: where and when it caught are found again."""

import numpy as np
from caretree.learning.gap.cloth.catches import best_catch
from caretree.learning.gap.cloth.fitting import ClothFitter, ClothModel
from caretree.learning.gap.cloth.scene import ClothEpisode
from caretree.sim.effects.cloth.proxy_bodies import spread_vertices
from caretree.sim.effects.model_file import EffectEntry

from ..sheet import VERTICES, plain_sheet

STEPS = {("snag", "stiffness"): 0.1}
T = np.linspace(0.0, 1.0, 50)


class Straight:
    """A simulator in which a snag moves the markers by its place's own pattern, growing while it holds."""

    def __init__(self):
        self.parts = VERTICES[spread_vertices(VERTICES, 12, set())]
        self.patterns = np.random.default_rng(0).normal(size=(len(self.parts), 6))

    def run(self, episode, effects=(), physics=None):
        out = np.zeros((len(T), 6))
        for v in (e.parameters for e in effects if e.name == "snag"):
            k = int(np.argmin(np.linalg.norm(self.parts - [v["x"], v["y"], v["z"]], axis=1)))
            held = np.clip((T - v["t0"]) / 0.2, 0.0, 1.0) - np.clip((T - v["t1"]) / 0.2, 0.0, 1.0)
            out += v["stiffness"] * held[:, None] * self.patterns[k]
        return out

    def ahead(self, wanted):
        pass


def snag(place, stiffness, t0, t1):
    where = {a: float(x) for a, x in zip("xyz", place, strict=True)}
    return EffectEntry(name="snag", target="region", parameters={"stiffness": stiffness, **where, "t0": t0, "t1": t1})


def test_a_snag_is_moved_to_where_and_when_it_caught():
    sim = Straight()
    scene = plain_sheet()
    episode = ClothEpisode(name="e", role="fit", t=T, markers=np.zeros((len(T), 2, 3)), load=None, pins=())
    near = np.argsort(np.linalg.norm(sim.parts - sim.parts[3], axis=1))
    fitter = ClothFitter(sim, [episode], np.ones(6))
    noise = 1e-4 * np.random.default_rng(1).normal(size=(len(T), 6))
    fitter.data = [sim.run(episode, (snag(sim.parts[3], 0.5, 0.28, 0.71),)) + noise]
    model = ClothModel(effects=(snag(sim.parts[near[2]], 0.8, 0.5, 0.6),), free=(("snag", "stiffness"),))
    found = best_catch(fitter, fitter.fit(model, STEPS), scene, STEPS).model.effects[0].parameters
    assert np.allclose([found[a] for a in "xyz"], sim.parts[3])
    assert np.allclose([found["t0"], found["t1"]], [0.28, 0.71], atol=0.02)
