"""A push that moves the cloth much farther than what is to be explained says little, and is made smaller."""

from dataclasses import replace

import numpy as np
from caretree.learning.gap.cloth.candidates import candidates
from caretree.learning.gap.cloth.fitting import ClothFitter, ClothModel
from caretree.learning.gap.cloth.scene import read_scene
from caretree.learning.gap.cloth.screening import FAR, probe, screened, sized
from caretree.learning.gap.measurement import load_set

from .straight import NOISE, Straight

DRAG = 0.08


class Buckling(Straight):
    """What little drag does it does in proportion, and much of it something else."""

    def run(self, episode, effects=(), physics=None):
        out = super().run(episode, effects, physics)
        drag = sum(e.parameters["coefficient"] for e in effects if e.name == "air_drag")
        return out + 5.0 * max(drag - 0.1, 0.0) * self.pattern("buckling", "coefficient")


def screening(cloth_set):
    scene, episodes = read_scene(load_set(cloth_set))
    sim = Buckling(len(episodes[0].t))
    seen = DRAG * sim.pattern("air_drag", "coefficient")
    seen = seen + 0.01 * NOISE * np.random.default_rng(3).normal(size=seen.shape)
    told = replace(episodes[0], markers=seen[:, :15].reshape(len(seen), 5, 3), load=seen[:, 15:])
    fitter = ClothFitter(sim, [told], np.full(18, 1.0 / NOISE))
    left = fitter.residuals(ClothModel())
    return fitter, candidates(scene, [told], left), float(np.sqrt(fitter.rss(left)))


def test_a_push_is_made_smaller_until_it_tells_what_a_small_size_does(cloth_set):
    fitter, pool, most = screening(cloth_set)
    drag = next(c for c in pool if c.name == "air_drag")
    found = probe(fitter, ClothModel(), [drag], most)[0]
    assert np.linalg.norm(found.columns) < FAR * most
    assert found.candidate.push.value(("air_drag", "coefficient")) < 0.1
    assert found.candidate.steps[("air_drag", "coefficient")] < drag.steps[("air_drag", "coefficient")]


def test_the_size_that_is_wanted_follows(cloth_set):
    fitter, pool, most = screening(cloth_set)
    nothing = np.zeros((len(fitter.flat(fitter.residuals(ClothModel()))), 0))
    ranked, left = screened(fitter, ClothModel(), nothing, pool, most)
    assert ranked[0].name == "air_drag"
    assert left["air_drag"] < 0.1 * most**2
    assert np.isclose(ranked[0].push.value(("air_drag", "coefficient")), DRAG, rtol=0.1)


def test_what_would_have_to_act_the_wrong_way_round_is_none(cloth_set):
    fitter, pool, most = screening(cloth_set)
    found = probe(fitter, ClothModel(), [next(c for c in pool if c.name == "air_drag")], most)[0]
    assert sized(found, np.zeros((len(found.start), 0)), -found.start)[0] is None
