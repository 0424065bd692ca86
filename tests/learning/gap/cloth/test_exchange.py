"""A search that took the wrong effect first leaves it again."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.gap.cloth.candidates import candidates
from caretree.learning.gap.cloth.exchange import Exchange, Other
from caretree.learning.gap.cloth.fitting import ClothFitter, ClothModel
from caretree.learning.gap.cloth.polish import steps_of
from caretree.learning.gap.cloth.scene import read_scene
from caretree.learning.gap.measurement import load_set

from .straight import NOISE, Straight


@pytest.fixture
def around(cloth_set):
    """A recording of tilted gravity and a delay, of which air drag and the delay were named."""
    scene, episodes = read_scene(load_set(cloth_set))
    sim = Straight(len(episodes[0].t))
    seen = 2.0 * sim.pattern("tilted_gravity", "towards_x") + 2.0 * sim.pattern("delay", "time")
    seen = seen + NOISE * np.random.default_rng(5).normal(size=seen.shape)
    told = replace(episodes[0], markers=seen[:, :15].reshape(len(seen), 5, 3), load=seen[:, 15:])
    fitter = ClothFitter(sim, [told], np.full(18, 1.0 / NOISE))
    pool = {c.name: c for c in candidates(scene, [told], fitter.residuals(ClothModel()))}
    named = (pool["air_drag"], pool["delay"])
    fit = fitter.fit(named[0].start.joined(named[1].start), steps_of(named))
    return Exchange(fitter=fitter, scene=scene, named=Other(chosen=named, fit=fit), worth=float(seen.size))


def test_what_explains_more_in_a_members_place_is_found(around):
    drag, delay = around.named.chosen
    best = min(around.instead(drag), key=around.worse)
    assert [c.name for c in best.chosen] in (["delay", "tilted_gravity"], ["delay", "wind"])
    assert around.worse(best) < -100.0
    assert all(around.worse(o) > -100.0 for o in around.instead(delay))


def test_without_a_member_less_is_explained(around):
    drag, delay = around.named.chosen
    assert around.worse(around.without(delay)) > 100.0
    assert around.worse(around.without(drag)) < 20.0
    assert around.without(delay).chosen == (drag,)


def test_places_and_instants_count_among_the_numbers(around):
    assert around.named.numbers == 2
    snag = next(
        c for c in candidates(around.scene, around.fitter.episodes, around.named.fit.residuals) if c.name == "snag"
    )
    joined = replace(around.named.fit, model=around.named.fit.model.joined(snag.start))
    assert Other(chosen=(*around.named.chosen, snag), fit=joined).numbers == 6
