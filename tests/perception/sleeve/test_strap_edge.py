"""The strap between an armhole and the gown's edge, from pictures painted by hand."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.sleeve.strap_edge import strap_between
from caretree.sim.world import Frame

DOWN = np.array(((1.0, 0.0, 0.0, 0.0), (0.0, -1.0, 0.0, 0.0), (0.0, 0.0, -1.0, 2.0), (0.0, 0.0, 0.0, 1.0)))
MAGENTA, NAVY, PRINTED, PLAIN = (180, 40, 110), (20, 34, 92), (118, 172, 219), (194, 219, 240)
MIDDLE = 53.5  # row of the strap's middle line


def picture(strap=PRINTED, neckline=0, upside_down=False):
    """A camera 1 m above a sleeve, its armhole and its strap, each right across the picture, 5 mm a pixel.

    The strap is 11 rows wide and borders on the bed, which lies 5 cm lower, at the picture's lower edge: headward.
    The first `neckline` columns of it are navy.
    """
    rgb, depth = np.full((120, 160, 3), 128, np.uint8), np.full((120, 160), 1.05, np.float32)
    rgb[10:34], rgb[34:48], rgb[48:59] = PRINTED, MAGENTA, strap
    rgb[48:59, :neckline] = NAVY
    depth[10:59] = 1.0
    if upside_down:
        rgb, depth = rgb[::-1].copy(), depth[::-1].copy()
    return Frame(
        camera="right_hand",
        stamp=1.0,
        rgb=rgb,
        depth=depth,
        intrinsics=(200.0, 200.0, 80.0, 60.0),
        pose_camera_in_map=DOWN,
    )


NEAR = np.array((0.0, 0.08, 1.0))  # in the armhole's tape


@pytest.mark.parametrize(("colour", "inside"), [(PRINTED, False), (PLAIN, True)])
def test_the_strap_lies_between_the_armhole_and_the_edge(colour, inside):
    strap = strap_between(picture(colour), NEAR)
    assert strap.middle[1:] == pytest.approx(((60 - MIDDLE) * 0.005, 1.0), abs=0.012)
    np.testing.assert_allclose(strap.across, (0, -1, 0), atol=0.05)
    np.testing.assert_allclose(strap.normal, (0, 0, 1), atol=0.05)
    assert strap.inside is inside
    assert np.abs(strap.rim[:, 1] - (60 - 41) * 0.005).max() < 0.04


def test_the_end_of_the_neckline_tells_the_middle_of_the_strap():
    strap = strap_between(picture(neckline=60), NEAR)
    assert strap.middle[0] == pytest.approx((60 - 80) * 0.005 + 0.082, abs=0.03)


def test_a_strip_far_from_the_end_of_the_neckline_is_no_strap():
    frame = picture(neckline=45)
    gap = np.s_[48:59, 45:95]  # what is left of the strap begins 0.25 m from the neckline's end
    frame.rgb[gap], frame.depth[gap] = 128, 1.05
    with pytest.raises(PerceptionFailure, match="neck binding"):
        strap_between(frame, NEAR)


def test_an_edge_on_the_feet_s_side_is_not_the_strap_s():
    with pytest.raises(PerceptionFailure, match="strap"):
        strap_between(picture(upside_down=True), NEAR * (1.0, -1.0, 1.0))


def test_no_armhole_near():
    with pytest.raises(PerceptionFailure, match="rim"):
        strap_between(picture(), NEAR + (0.0, 0.5, 0.0))
