"""The strap by the network's scores and the place where it is looked for."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.image.surfaces import Surface
from caretree.perception.learned.sight import Sight
from caretree.perception.learned.strap import AFAR, strap_in
from caretree.sim.world import Frame

CELLS, SIZE = (48, 64), (192, 256)  # rows and columns; a camera above a flat gown, its image's right is the map's +x


def frame():
    return Frame(
        camera="left_hand",
        stamp=3.0,
        rgb=np.zeros((*SIZE, 3), np.uint8),
        depth=np.full(SIZE, 0.4, np.float32),
        intrinsics=(200.0, 200.0, 127.5, 95.5),
        pose_camera_in_map=np.diag((1.0, -1.0, -1.0, 1.0)),
    )


def sight(*peaks, surface=Surface.OUTSIDE):
    """Peaks are of (row, column, score) [cells]."""
    heat = np.full(CELLS, -12.0)
    for row, column, score in peaks:
        heat[row, column] = score
    sheet = np.zeros((*SIZE, 3), np.float32)
    surfaces = np.full(SIZE, surface, np.uint8)
    surfaces[:, 160:] = Surface.ARMHOLE if surface == Surface.OUTSIDE else surface
    return Sight(surfaces=surfaces, confidence=np.ones(SIZE), sheet=sheet, key_points={}, heat={"strap_left": heat})


def place(row, column):
    """(3,) of a cell's middle in the map."""
    x, y = (((at + 0.5) * 4 - 0.5 - middle) / 200.0 * 0.4 for at, middle in ((column, 127.5), (row, 95.5)))
    return np.array((x, -y, -0.4))


def test_the_strap_is_at_the_peak():
    found = strap_in(frame(), sight((20, 30, 3.0)), "left", place(24, 34))
    assert found.position_in_map == pytest.approx(place(20, 30), abs=0.004)
    assert (found.target, found.stamp) == ("sleeve_left", 3.0)
    assert found.armhole_points_in_map[:, 0].min() > 0.06, "what is seen of the rim, to the right"


@pytest.mark.parametrize("near", [(12, 14), (36, 50)])
def test_of_two_peaks_the_one_near_to_where_it_was_seen_from_afar_is_meant(near):
    seen = sight((12, 14, 3.0), (36, 50, 3.0))
    assert strap_in(frame(), seen, "left", place(*near)).position_in_map == pytest.approx(place(*near), abs=0.03)


@pytest.mark.parametrize("side", ["left", "right"])
def test_closing_is_across_a_strap_that_lies_outwards(side):
    seen = sight((20, 30, 3.0))
    seen.heat["strap_right"] = seen.heat["strap_left"]
    found = strap_in(frame(), seen, side, place(20, 30))
    assert found.approach_in_map == pytest.approx((0, 0, -1), abs=1e-6)
    along = np.cross(found.approach_in_map, found.closing_in_map)
    # outwards is the map's -x on the left, and along is outwards on the left, inwards on the right
    assert along == pytest.approx((-1, 0, 0), abs=1e-6)


def test_a_peak_beyond_where_it_is_looked_for_is_another_one():
    seen = sight((4, 4, 3.0))
    assert 0.9 < strap_in(frame(), seen, "left", place(4, 4)).confidence < 1.0
    with pytest.raises(PerceptionFailure, match="strap of the left armhole"):
        strap_in(frame(), seen, "left", place(40, 44))
    assert strap_in(frame(), seen, "left", place(40, 44), AFAR).confidence > 0.9


def test_no_peak_is_no_strap():
    with pytest.raises(PerceptionFailure, match="strap of the left armhole"):
        strap_in(frame(), sight(), "left", place(20, 30))


def test_where_no_gown_is_there_is_no_strap():
    with pytest.raises(PerceptionFailure, match="left armhole"):
        strap_in(frame(), sight((20, 30, 3.0), surface=Surface.SKIN), "left", place(20, 30))
