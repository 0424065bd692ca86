from dataclasses import replace

import numpy as np
from caretree.learning.gap.cloth.candidates import candidates
from caretree.learning.gap.cloth.fitting import ClothFitter, ClothModel
from caretree.learning.gap.cloth.polish import settled, steps_of
from caretree.learning.gap.cloth.scene import read_scene
from caretree.learning.gap.measurement import load_set

STEP = 0.03  # of a tilt, over which the cloth bends
TRUE = {("tilted_gravity", "towards_x"): 0.034, ("tilted_gravity", "towards_y"): 0.0135}


class Bending:
    """A cloth whose answer to a tilt bends: a little more along x undoes what a little more along y did."""

    def __init__(self, rows):
        rng = np.random.default_rng(4)
        self.along, self.bend = 1e-3 * rng.normal(size=(2, rows, 18))

    def run(self, episode, effects=(), physics=None):
        tilt = next((e.parameters for e in effects if e.name == "tilted_gravity"), {})
        x, y = (tilt.get(k, 0.0) / STEP for k in ("towards_x", "towards_y"))
        return (x + y) * self.along + ((x + y) * 8.0 * y + y - 6.0 * x * x) * self.bend

    def ahead(self, wanted):
        pass


def test_finer_differences_go_on_where_coarse_ones_stand_still(cloth_set):
    scene, episodes = read_scene(load_set(cloth_set))
    rows = len(episodes[0].t)
    sim = Bending(rows)
    tilt = next(
        c for c in candidates(scene, episodes, [np.zeros((rows, 18))] * len(episodes)) if c.name == "tilted_gravity"
    )
    seen = sim.run(episodes[0], tilt.push.moved(TRUE).effects) + 1e-5 * np.random.default_rng(6).normal(size=(rows, 18))
    told = replace(episodes[0], markers=seen[:, :15].reshape(rows, 5, 3), load=seen[:, 15:])
    fitter = ClothFitter(sim, [told], np.full(18, 1e5))
    coarse = fitter.fit(ClothModel().joined(tilt.start), steps_of([tilt]), rounds=3)
    fine = settled(fitter, coarse, [tilt])
    assert fine.rss < 0.5 * coarse.rss
    assert np.allclose([fine.model.value(f) for f in TRUE], list(TRUE.values()), rtol=0.02)
    assert settled(fitter, fine, [tilt]) is fine  # nothing is left to gain
