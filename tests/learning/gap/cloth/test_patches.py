"""A cloth whose parts answer to a load one by one: the patch a mass sits on is found again."""

import numpy as np
from caretree.learning.gap.cloth.fitting import ClothFitter, ClothModel
from caretree.learning.gap.cloth.patches import best_patch
from caretree.learning.gap.cloth.scene import ClothEpisode, Pin
from caretree.sim.effects.cloth.added_mass import AddedMass
from caretree.sim.effects.cloth.proxy_bodies import spread_vertices
from caretree.sim.effects.model_file import EffectEntry

from ..sheet import VERTICES, plain_sheet

STEPS = {("added_mass", "mass"): 0.01}


class Straight:
    """A simulator in which every proxy body's load moves the markers by its own fixed pattern, in proportion."""

    def __init__(self, proxies):
        self.proxies = proxies
        self.patterns = np.random.default_rng(0).normal(size=(len(proxies), 20, 6))

    def run(self, episode, effects=(), physics=None):
        shares = sum(AddedMass().share(self.proxies, e.parameters) for e in effects if e.name == "added_mass")
        return np.tensordot(shares + 0.0 * self.proxies[:, 0], self.patterns, 1)

    def ahead(self, wanted):
        pass


def entry(x, z, mass, radius):
    return EffectEntry(name="added_mass", target="region", parameters=dict(mass=mass, x=x, y=0.0, z=z, radius=radius))


def test_a_mass_is_moved_to_the_patch_it_sits_on():
    pins = (Pin(vertices=(0, 1), release_t=float("inf"), path=None),)
    proxies = VERTICES[spread_vertices(VERTICES, 12, {0, 1})]
    scene = plain_sheet()
    sim = Straight(proxies)
    episode = ClothEpisode(
        name="e", role="fit", t=np.arange(20) / 20, markers=np.zeros((20, 2, 3)), load=None, pins=pins
    )
    hidden = entry(0.35, -0.35, 0.03, 0.15)
    seen = sim.run(episode, (hidden,)) + 1e-5 * np.random.default_rng(1).normal(size=(20, 6))
    fitter = ClothFitter(sim, [episode], np.ones(6))
    fitter.data = [seen]
    model = ClothModel(effects=(entry(0.07, -0.35, 0.02, 0.1),), free=(("added_mass", "mass"),))
    found = best_patch(fitter, fitter.fit(model, STEPS), scene, STEPS)
    there = AddedMass().share(proxies, found.model.effects[0].parameters)
    assert np.allclose(there, AddedMass().share(proxies, hidden.parameters), atol=1e-3)
    assert found.rss < 1e-6
