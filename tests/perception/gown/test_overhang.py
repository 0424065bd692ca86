"""How much of the gown shows beyond an edge of the bed, from pictures painted by hand."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.gown.overhang import overhang

from ..sleeve.test_worn_sleeve import picture

BED = np.array(((-0.05, -1.0, 0.0), (0.15, 1.0, 0.6)))  # a narrow one


@pytest.mark.parametrize(("side", "share"), [("right", 0.5), ("left", 0.25)])
def test_what_shows_beyond_an_edge_counts_by_its_area(side, share):
    # 5 mm a pixel, the middle of the picture at x = 0: 0.10 m beyond the left edge, 0.20 m beyond the right one
    seen = overhang(picture((50, 70), (110, 130)), BED, "right" if side == "right" else "left")
    assert seen.share == pytest.approx({"right": 0.5, "left": 0.5}[side], abs=0.03)


def test_nearer_cloth_counts_for_less_a_pixel():
    frame = picture((50, 70), (110, 130))
    frame.depth[:, 110:130] = 0.5  # and 0.075 to 0.125 m from the middle: on the bed
    assert overhang(frame, BED, "right").share == 0.0
    assert overhang(frame, BED, "left").share == pytest.approx(0.8, abs=0.03)


def test_a_gown_that_hardly_shows_tells_nothing():
    with pytest.raises(PerceptionFailure):
        overhang(picture((50, 52), (110, 112)), BED, "right")
