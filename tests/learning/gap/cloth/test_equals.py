from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.gap.cloth.candidates import candidates
from caretree.learning.gap.cloth.equals import equals
from caretree.learning.gap.cloth.fitting import ClothFitter, ClothModel
from caretree.learning.gap.cloth.noise import coherence, neighbours
from caretree.learning.gap.cloth.polish import steps_of
from caretree.learning.gap.cloth.scene import read_scene
from caretree.learning.gap.cloth.search import ClothSearch
from caretree.learning.gap.measurement import load_set

from .straight import NOISE, Straight


@pytest.fixture
def exchanged(cloth_set):
    """What is equal to tilted gravity and a delay of some size, hidden in two recordings, the second held out."""
    scene, episodes = read_scene(load_set(cloth_set))
    sim = Straight(len(episodes[0].t))

    def make(delays, strange=0.0):
        told = []
        for k, (e, delay) in enumerate(zip(episodes, delays, strict=True)):
            seen = 2.0 * sim.pattern("tilted_gravity", "towards_x") + delay * sim.pattern("delay", "time")
            seen = seen + strange * sim.pattern("air_drag", "coefficient")
            seen = seen + NOISE * np.random.default_rng([5, k]).normal(size=seen.shape)
            told.append(replace(e, markers=seen[:, :15].reshape(len(seen), 5, 3), load=seen[:, 15:]))
        fitted, heldout = told[:1], told[1:]
        fitter = ClothFitter(sim, fitted, np.full(18, 1.0 / NOISE))
        plain = fitter.fit(ClothModel(), {})
        pool = {c.name: c for c in candidates(scene, fitted, plain.residuals)}
        chosen = (pool["tilted_gravity"], pool["delay"])
        fit = fitter.fit(chosen[0].start.joined(chosen[1].start), steps_of(list(chosen)))
        calm = coherence(fit.residuals, neighbours(scene.vertices[list(scene.markers)]), 5)
        found = ClothSearch(
            chosen=chosen,
            fit=fit,
            sure=fit,
            plain=plain,
            before=calm,
            after=calm,
            rivals={},
            worth=float(plain.residuals[0].size),
            weights=fitter.weights,
        )
        return equals(sim, scene, fitted, heldout, found)

    return make


def test_what_does_the_same_is_told_and_nothing_else(exchanged):
    found = exchanged((2.0, 2.0))
    assert found.instead == {"tilted_gravity": ("wind",), "delay": ()}
    assert [{name for name, _ in s} for s in found.sets] == [{"wind", "delay"}]


@pytest.mark.parametrize(("held_out", "sets"), [(0.0, [(("tilted_gravity", "cloth"),)]), (0.35, [])])
def test_what_only_the_fitted_recordings_have_may_not_be_there(exchanged, held_out, sets):
    assert [s for s in exchanged((0.16, held_out)).sets if len(s) == 1] == sets


@pytest.mark.parametrize(("strange", "beside"), [(0.3, [{"tilted_gravity", "delay", "air_drag"}]), (0.0, [])])
def test_what_gains_more_beside_the_named_ones_than_noise_is_told(exchanged, strange, beside):
    assert [{name for name, _ in s} for s in exchanged((2.0, 2.0), strange).sets if len(s) == 3] == beside


def test_a_number_is_as_sure_as_it_is_in_all_sets_that_are_told(exchanged):
    time = ("delay", "time")
    alone, both = (exchanged((2.0, 2.0), strange).spread for strange in (0.0, 0.3))
    assert set(alone) == {time}  # a tilt is no number of the set with wind in its place
    assert set(both) == {time, ("tilted_gravity", "towards_x"), ("tilted_gravity", "towards_y")}
    assert all(ends[0] < 0.02 < ends[1] for ends in (alone[time], both[time]))
