"""The strips in which the neckline's tape falls from the hook, on pictures painted by hand."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.gown.hung_corner import hook
from caretree.perception.gown.neckline_strip import StripTuning, strips
from caretree.sim.quantity import changed

from .test_hung_side import PLAIN, PRINTED, picture


def told(frame, tuning=None):
    """The surest strip on either side of the hook, by which way it falls in the picture: left, right."""
    top = hook(frame).position_in_map
    found = strips(frame, top) if tuning is None else strips(frame, top, tuning)
    sides = [[s for s in found if np.sign(s.tip_in_map[0] - top[0]) == sign] for sign in (-1.0, 1.0)]
    return [max(some, key=lambda s: s.length) if some else None for some in sides]


def test_both_strips_end_where_the_tape_does():
    top = hook(picture(PRINTED)).position_in_map
    for strip in told(picture(PRINTED)):
        way = strip.tip_in_map - top
        assert 0.25 < abs(way[0]) < 0.32  # [m]: the tape falls 59 pixels of 5 mm at 45 degrees
        assert 0.25 < -way[2] < 0.33
        assert abs(strip.along_in_map[0]) == pytest.approx(0.7, abs=0.1)


def test_the_fabric_beside_it_tells_which_strip_it_is_and_the_inside_swaps_them():
    outside, inside = told(picture(PRINTED)), told(picture(PLAIN))
    assert outside[0].tells * outside[1].tells < 0.0
    for one, other in zip(outside, inside, strict=True):
        assert abs(one.tells) > 0.5
        assert one.tells == pytest.approx(-other.tells)


def test_a_strip_that_is_cut_off_by_the_border_of_the_picture_does_not_show_its_end():
    whole = picture(PRINTED)
    cut_off = replace(whole, rgb=whole.rgb[:70], depth=whole.depth[:70])  # the tape goes on to row 75
    assert all(strip.whole for strip in told(whole))
    for strip in told(cut_off):
        assert not strip.whole
        assert not strip.shows


def test_no_tape_no_strip():
    bare = picture(PRINTED, strips=False)
    assert strips(bare, hook(bare).position_in_map) == []


def test_patches_smaller_than_asked_for_are_no_strips():
    assert told(picture(PRINTED), changed(StripTuning(), {"min_points": 5000})) == [None, None]
