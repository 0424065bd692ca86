"""Every surface is told apart under every light and hue that the room may have."""

import numpy as np
import pytest
from caretree.perception.image.surfaces import Surface, surfaces, surfaces_at
from caretree.sim.render.appearance import draw_appearance
from caretree.sim.robot.shapes import BLACK, DARK, RED, STEEL


@pytest.mark.parametrize(
    ("name", "surface"),
    [
        ("gown_outside", Surface.OUTSIDE),
        ("gown_inside", Surface.INSIDE),
        ("collar", Surface.COLLAR),
        ("armhole", Surface.ARMHOLE),
        ("cuff", Surface.CUFF),
        ("skin", Surface.SKIN),
        ("sheet", Surface.OTHER),
        ("floor", Surface.OTHER),
        ("wall", Surface.OTHER),
        ("robot", Surface.OTHER),
        ("robot_grey", Surface.OTHER),
        ("rail", Surface.OTHER),
        ("shorts", Surface.OTHER),
        ("bed_frame", Surface.OTHER),
    ],
)
@pytest.mark.parametrize("shade", [0.62, 1.0])
def test_flat_patches(name, surface, shade):
    right = []
    for seed in range(25):
        rng = np.random.default_rng(seed)
        look = draw_appearance(rng)
        colour = np.array(look.colours[name]) * look.light.intensity * 0.82 * shade
        patch = np.clip(colour + rng.normal(0, 2, (24, 24, 3)), 0, 255).astype(np.uint8)
        right.append((surfaces(patch) == surface).mean())
    assert np.mean(right) > 0.98
    assert min(right) > 0.85


@pytest.mark.parametrize("colour", [BLACK, DARK, RED, STEEL])
@pytest.mark.parametrize("light", [0.35, 0.6, 1.0])
def test_the_robot_is_neither_gown_nor_person(colour, light):
    noise = np.random.default_rng(0).normal(0, 2, (64, 64, 3))
    patch = np.clip(255 * light * np.array(colour) + noise, 0, 255).astype(np.uint8)
    assert (surfaces(patch) == Surface.OTHER).mean() > 0.99


def test_some_pixels_are_told_apart_as_in_the_whole_picture():
    rng = np.random.default_rng(0)
    rgb = rng.integers(0, 256, (40, 60, 3), dtype=np.uint8)
    whole = surfaces(rgb)
    for low, high in ((0, 40), (0, 6), (34, 40), (17, 18)):
        rows, columns = rng.integers(low, high, 20), rng.integers(low, high, 20)
        np.testing.assert_array_equal(surfaces_at(rgb, rows, columns), whole[rows, columns])


def test_some_pixels_are_labelled_as_in_the_whole_picture():
    generator = np.random.default_rng(0)
    picture = generator.integers(0, 255, (60, 80, 3), dtype=np.uint8)
    rows, columns = generator.integers(0, 60, 40), generator.integers(0, 80, 40)
    assert np.array_equal(surfaces_at(picture, rows, columns), surfaces(picture)[rows, columns])
