"""How a fit begins, and how it ends."""

from dataclasses import replace

import numpy as np
from caretree.learning.gap.cloth.candidates import Candidate, candidates
from caretree.learning.gap.cloth.fitting import ClothFitter, ClothModel
from caretree.learning.gap.cloth.polish import INSTANTS, begun, rested, settled, steps_of, sure
from caretree.learning.gap.cloth.scene import ClothEpisode, read_scene
from caretree.learning.gap.measurement import load_set
from caretree.sim.effects.model_file import EffectEntry

SIZE = ("air_drag", "coefficient")
NOISE = 1e-3
STEP = 0.002  # of a simulation [s]


class Saturating:
    """A cloth that drag slows down, much of it hardly more than some."""

    def __init__(self, rows):
        self.way = np.random.default_rng(2).normal(size=(rows, 18))

    def run(self, episode, effects=(), physics=None):
        drag = sum(e.parameters["coefficient"] for e in effects if e.name == "air_drag")
        return 10.0 * NOISE * np.tanh(20.0 * drag) * self.way

    def ahead(self, wanted):
        pass


def dragged(cloth_set, size, seed):
    scene, episodes = read_scene(load_set(cloth_set))
    rows = len(episodes[0].t)
    drag = next(c for c in candidates(scene, episodes, [np.zeros((rows, 18))] * 2) if c.name == "air_drag")
    sim = Saturating(rows)
    seen = sim.run(episodes[0], drag.push.moved({SIZE: size}).effects)
    seen = seen + NOISE * np.random.default_rng(seed).normal(size=seen.shape)
    told = replace(episodes[0], markers=seen[:, :15].reshape(rows, 5, 3), load=seen[:, 15:])
    return ClothFitter(sim, [told], np.full(18, 1.0 / NOISE)), drag


def test_what_saturates_is_begun_with_at_a_small_size(cloth_set):
    fitter, drag = dragged(cloth_set, 0.03, 10)
    first = begun(fitter, ClothModel(), drag, fitter.rss(fitter.residuals(ClothModel())))
    assert first.push.value(SIZE) < 0.1
    assert first.steps[SIZE] < 0.1
    fit = fitter.fit(first.push, steps_of([first]), rounds=5)
    assert np.isclose(fit.model.value(SIZE), 0.03, rtol=0.1)


def test_the_last_fit_ends_at_the_best_value_and_not_near_it(cloth_set):
    """Ends within a tenth of the half-width, where one that stops at a part of the sum of squares may not."""
    off = {"rested": [], "settled": []}
    for seed in range(10, 30):
        fitter, drag = dragged(cloth_set, 0.03, seed)
        near = fitter.fit(drag.push.moved({SIZE: 0.0303}), {}, rounds=0)
        worth = float(near.residuals[0].size)
        best = fitter.fit(drag.push.moved({SIZE: 0.03}), {SIZE: 1e-3}, rounds=20, least=1e-9)
        for name, fit in (("rested", rested(fitter, near, [drag], worth)), ("settled", settled(fitter, near, [drag]))):
            off[name].append(abs(fit.model.value(SIZE) - best.model.value(SIZE)) / best.half[0])
    assert max(off["rested"]) < 0.1
    assert max(off["settled"]) > 0.4


class Stepping:
    """A cloth that is caught from one of the simulation's steps on."""

    pull = np.random.default_rng(0).normal(size=12)

    def run(self, episode, effects=(), physics=None):
        values = effects[0].parameters
        since = np.maximum(episode.t - STEP * np.ceil(values["t0"] / STEP), 0.0)
        return 0.1 * values["stiffness"] * since[:, None] * self.pull

    def ahead(self, wanted):
        pass


def test_an_instant_is_as_sure_wherever_between_two_steps_it_lies():
    t = np.linspace(0.0, 1.0, 60)
    episode = ClothEpisode(name="e", role="fit", t=t, markers=np.zeros((60, 4, 3)), load=None, pins=())
    fitter = ClothFitter(Stepping(), [episode], np.full(12, 1.0 / NOISE))
    noise = NOISE * np.random.default_rng(1).normal(size=(60, 12))
    values = {"stiffness": 1.0, "x": 0.0, "y": 0.0, "z": 0.0, "t0": 0.3, "t1": 2.0}
    half = []
    for late in np.linspace(0.0, STEP, 7):
        entry = EffectEntry(name="snag", target="region", parameters={**values, "t0": 0.3 + late})
        model = ClothModel(effects=(entry,), free=(("snag", "stiffness"),))
        fitter.data = [Stepping().run(episode, model.effects) + noise]
        snag = Candidate(name="snag", target="region", start=model, push=model, steps={("snag", "stiffness"): 0.1})
        known = sure(fitter, fitter.fit(model, {}, rounds=0), [snag])
        half.append(known.half[known.model.free.index(("snag", "t0"))])
    assert ("snag", "t0") in INSTANTS
    assert np.ptp(half) < 0.1 * np.mean(half)
