"""How sure a stiffness is that was fitted beside the stretch from which it acts."""

from dataclasses import replace

import numpy as np
from caretree.learning.gap.cloth.candidates import Candidate
from caretree.learning.gap.cloth.fitting import ClothFitter, ClothModel
from caretree.learning.gap.cloth.polish import ONSET, sure
from caretree.learning.gap.cloth.scene import ClothEpisode
from caretree.sim.effects.model_file import EffectEntry

T = np.linspace(0.0, 1.0, 50)
NOISE, STIFFNESS, START = 1e-3, 3.0, 0.04
SIZE = ("strain_stiffening", "stiffness")
STEPS = {SIZE: 0.5}


def stiffening(stiffness, onset):
    values = {"stiffness": stiffness, "onset": onset}
    return ClothModel(effects=(EffectEntry(name=SIZE[0], target="cloth", parameters=values),), free=(SIZE,))


class Stretched:
    """A cloth whose markers are held back by what it is stretched beyond the onset."""

    stretch = 0.1 * np.outer(np.sin(np.pi * T), np.linspace(0.3, 1.0, 6))

    def run(self, episode, effects=(), physics=None):
        values = effects[0].parameters
        return 0.01 * values["stiffness"] * np.maximum(self.stretch - values["onset"], 0.0)

    def ahead(self, wanted):
        pass


def test_what_was_fitted_beside_it_makes_a_number_less_sure_and_has_an_interval_of_its_own():
    sim, model = Stretched(), stiffening(STIFFNESS, START)
    episode = ClothEpisode(name="e", role="fit", t=T, markers=np.zeros((len(T), 2, 3)), load=None, pins=())
    chosen = [Candidate(name=SIZE[0], target="cloth", start=stiffening(0.0, START), push=model, steps=STEPS)]
    alone, together, onset, draws = 0, 0, 0, 40
    for seed in range(draws):
        fitter = ClothFitter(sim, [episode], np.full(6, 1.0 / NOISE))
        noise = NOISE * np.random.default_rng(seed).normal(size=(len(T), 6))
        fitter.data = [sim.run(episode, model.effects) + noise]
        both = fitter.fit(replace(model, free=(SIZE, ONSET)), {**STEPS, ONSET: 0.004}, rounds=5)
        fit = fitter.fit(replace(both.model, free=(SIZE,)), STEPS)
        found = sure(fitter, fit, chosen)
        off = {f: abs(fit.model.value(f) - x) for f, x in ((SIZE, STIFFNESS), (ONSET, START))}
        alone += off[SIZE] < fit.half[0]
        together += off[SIZE] < found.half[0]
        onset += off[ONSET] < found.half[1]
        assert found.model.value(SIZE) == fit.model.value(SIZE)
    assert together >= 0.85 * draws
    assert onset >= 0.85 * draws
    assert alone < 0.85 * draws, "too sure"


def test_a_set_without_such_numbers_is_as_it_was():
    sim, tilt = Stretched(), ("tilted_gravity", "towards_x")
    episode = ClothEpisode(name="e", role="fit", t=T, markers=np.zeros((len(T), 2, 3)), load=None, pins=())
    fitter = ClothFitter(sim, [episode], np.ones(6))
    fitter.data = [np.zeros((len(T), 6))]
    model = stiffening(STIFFNESS, START)
    fit = fitter.fit(model, STEPS)
    chosen = [Candidate(name=tilt[0], target="cloth", start=model, push=model, steps=STEPS)]
    assert sure(fitter, fit, chosen) is fit
