"""Looks: drawn by the seed, taped unchanged, and what is held out never drawn for training."""

import colorsys

import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.render.appearance import draw_appearance
from caretree.sim.render.looks import FABRICS, HELD_OUT, LOOKS, SKINS, allowed, draw_look
from caretree.sim.render.raster import PATTERNS


@pytest.mark.parametrize("look", LOOKS)
def test_same_seed_same_look(look):
    one, other = (draw_look(look, np.random.default_rng(5)) for _ in range(2))
    assert one.colours == other.colours
    assert one.on_cloth == other.on_cloth


def test_taped_is_the_look_of_before():
    new, old = draw_look("taped", np.random.default_rng(7)), draw_appearance(np.random.default_rng(7))
    assert new.colours == old.colours
    assert new.on_cloth == old.on_cloth
    assert new.tint == (1.0, 1.0, 1.0)


@pytest.mark.parametrize("look", ["plain", "printed"])
def test_without_tapes_all_bindings_have_the_fabrics_hue(look):
    for seed in range(20):
        colours = draw_look(look, np.random.default_rng(seed)).colours
        share = np.array(colours["collar"]) / np.maximum(colours["gown_outside"], 1e-6)
        assert np.ptp(share) < 0.08, "a tape of another hue would still be read"
        assert colours["collar"] == colours["armhole"] == colours["cuff"]


def test_training_never_draws_what_is_held_out():
    for table, names in HELD_OUT.items():
        assert sorted(names) == sorted(allowed(table, held_out=True)), f"{table}: a name that is not there"
    patterns = {draw_look("printed", np.random.default_rng(seed)).on_cloth.pattern for seed in range(60)}
    assert patterns == set(PATTERNS) - {"diamonds"}
    kept = {draw_look("printed", np.random.default_rng(seed), held_out=True).on_cloth.pattern for seed in range(9)}
    assert kept == {"diamonds"}
    hues = [colorsys.rgb_to_hsv(*np.array(FABRICS[name]) / 255)[:2] for name in HELD_OUT["fabrics"]]
    for seed in range(60):
        red, green, blue = draw_look("plain", np.random.default_rng(seed)).colours["gown_outside"]
        hue, saturation, _ = colorsys.rgb_to_hsv(red / 255, green / 255, blue / 255)
        assert min(abs(hue - h) + abs(saturation - s) for h, s in hues) > 0.01


def test_skin_and_light_can_be_asked_for():
    look = draw_look("plain", np.random.default_rng(1), skin=10, light="warm")
    assert np.allclose(look.colours["skin"], np.array(SKINS[9]) * (1.0, 0.84, 0.64))


def test_an_unknown_look_is_refused_with_those_that_are_there():
    with pytest.raises(CaretreeError, match="unknown look 'velvet'; there are taped, plain, printed, random"):
        draw_look("velvet", np.random.default_rng(0))
