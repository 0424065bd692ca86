from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.gap.joints.search import Search
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study


@pytest.fixture
def search(axis_set):
    return open_study(load_set(axis_set(lambda q, v, a: 8.0 * v + 1.0))).named.search


def test_the_effects_that_act_are_chosen_whatever_the_start(search):
    names = {search.blocks[i].name for i in search.run()}
    assert names == {"viscous_friction", "offset"}
    wrong = next(i for i, b in enumerate(search.blocks) if b.name == "coulomb_friction")
    assert {search.blocks[i].name for i in search.run((wrong,))} == names


def test_on_another_residual_it_is_the_search_that_is_built_anew_for_it(search):
    b, yy = 0.3 * search.gram.b, 0.09 * search.gram.yy
    before = search.score(search.run())
    other = search.with_residual(b, yy)
    anew = Search(gram=replace(search.gram, b=b, yy=yy), noise=search.noise, strict=search.strict)
    chosen = anew.run()
    assert other.run() == chosen
    assert other.score(chosen) == anew.score(chosen)
    assert np.array_equal(other.gains(chosen), anew.gains(chosen))
    assert other.held(chosen) == anew.held(chosen)
    assert search.score(search.run()) == before


def test_unequal_friction_gives_way_to_one_that_falls_with_speed_and_an_offset(axis_set):
    study = open_study(load_set(axis_set(lambda q, v, a: np.sign(v) * (1.0 + 3.0 * np.exp(-((v / 0.05) ** 2))) - 1.5)))
    search = study.named.search
    unequal = next(i for i, b in enumerate(search.blocks) if b.name == "asymmetric_friction")
    assert {search.blocks[i].name for i in search.run((unequal,))} == {"stribeck_friction", "offset"}
