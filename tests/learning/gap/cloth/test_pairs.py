"""Two effects of which a third explains more than either alone are found together."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.gap.cloth.candidates import candidates
from caretree.learning.gap.cloth.fitting import ClothFitter, ClothModel
from caretree.learning.gap.cloth.pairs import paired
from caretree.learning.gap.cloth.scene import read_scene
from caretree.learning.gap.cloth.screening import probe, screened
from caretree.learning.gap.cloth.search import search
from caretree.learning.gap.measurement import load_set

from .straight import NOISE, Straight

BOTH = {("air_drag", "coefficient"): 2.0, ("offset", "x"): 0.006}  # each moves the cloth by twice the noise


class Between(Straight):
    """All markers move alike; tilted gravity does what drag and an offset do together, and a little of its own."""

    runs = 0

    def pattern(self, effect, parameter):
        between = (effect, parameter) == ("tilted_gravity", "towards_x")
        own = np.tile(super().pattern("between" if between else effect, parameter)[:, :3], (1, 6))
        if not between:
            return own
        return 0.7 * (self.pattern("air_drag", "coefficient") + self.pattern("offset", "x")) + 0.5 * own


@pytest.fixture
def recorded(cloth_set):
    """(simulator, scene, episodes) of recordings with both."""
    scene, episodes = read_scene(load_set(cloth_set))
    sim = Between(len(episodes[0].t))
    seen = 2.0 * sim.pattern("air_drag", "coefficient") + 2.0 * sim.pattern("offset", "x")
    told = []
    for k, e in enumerate(episodes):
        noisy = seen + 0.2 * NOISE * np.random.default_rng(k).normal(size=seen.shape)
        told.append(replace(e, markers=noisy[:, :15].reshape(len(noisy), 5, 3), load=noisy[:, 15:]))
    return sim, scene, told


def screening(recorded):
    """(fitter, probes, nothing that acts already) on the first recording."""
    sim, scene, told = recorded
    fitter = ClothFitter(sim, told[:1], np.full(18, 1.0 / NOISE))
    left = fitter.residuals(ClothModel())
    pool, most = candidates(scene, told[:1], left), float(np.sqrt(fitter.rss(left)))
    return fitter, pool, most, np.zeros((len(fitter.flat(left)), 0))


def test_the_pair_is_screened_before_all_others_at_the_sizes_it_has(recorded):
    fitter, pool, most, nothing = screening(recorded)
    best, second = paired(probe(fitter, ClothModel(), pool, most), nothing)[:2]
    found = {f: c.push.value(f) for c in best.members for f in c.start.free}
    assert {c.name for c in best.members} == {"air_drag", "offset"}
    assert all(np.isclose(found[f], x, rtol=0.05) for f, x in BOTH.items())
    assert best.left < 0.5 * second.left
    assert screened(fitter, ClothModel(), nothing, pool, most)[0][0].name == "tilted_gravity", "the best one alone"


def test_the_search_begins_with_it(recorded):
    sim, scene, told = recorded
    said = []
    found = search(sim, scene, told, said.append)
    assert {c.name for c in found.chosen} == {"air_drag", "offset"}
    assert not [text for text in said if text.startswith("round 2")], "one after the other, after tilted gravity"
