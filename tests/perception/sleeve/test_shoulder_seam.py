"""The outer end of the seam over a shoulder, from pictures painted by hand."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.sleeve.shoulder_seam import shoulder_seam
from caretree.sim.world import Frame

from .test_worn_sleeve import DOWN, MAGENTA

PRINTED, BARE = (110, 170, 215), (128, 128, 128)  # the outside of the gown, and what is no gown
NAVY = (20, 34, 92)  # the neckline's tape
SHOULDERS = np.array(((-0.2, 0.0, 1.0), (0.2, 0.0, 1.0)))  # the head is towards -y, which the picture shows below


def picture(*patches):
    """A camera 1 m above the shoulders, 5 mm a pixel.

    Patches: (x from, to, y from, to, height above them) [m], and a colour if it is not the printed outside.
    """
    rgb, depth = np.full((120, 160, 3), BARE, np.uint8), np.full((120, 160), 1.2, np.float32)
    rows, columns = np.mgrid[0:120, 0:160]
    for x0, x1, y0, y1, height, *colour in patches:
        away = 1.0 - height
        x, y = (columns - 80) / 200 * away, -(rows - 60) / 200 * away
        inside = (x0 <= x) & (x < x1) & (y0 <= y) & (y < y1)
        rgb[inside], depth[inside] = colour[0] if colour else PRINTED, away
    return Frame(
        camera="head", stamp=1.0, rgb=rgb, depth=depth, intrinsics=(200.0, 200.0, 80.0, 60.0), pose_camera_in_map=DOWN
    )


@pytest.mark.parametrize(("side", "x"), [("left", (-0.38, -0.30)), ("right", (0.30, 0.38))])
def test_it_is_the_cloth_beside_the_shoulder_that_is_nearest_to_the_head(side, x):
    seen = shoulder_seam(picture((*x, -0.10, 0.20, 0.0)), side, SHOULDERS)
    assert seen.position_in_map == pytest.approx((np.mean(x), -0.085, 1.0), abs=0.02)
    assert seen.approach_in_map == pytest.approx((0.0, 0.0, -1.0))
    assert abs(seen.closing_in_map @ (0.0, 1.0, 0.0)) == pytest.approx(1.0), "across the edge"
    assert seen.target == f"sleeve_{side}"


def test_neither_the_back_panel_on_the_bed_nor_the_neckline_that_stands_up_counts():
    seen = shoulder_seam(
        picture((0.30, 0.38, -0.20, 0.20, -0.10), (0.30, 0.38, -0.16, 0.0, 0.10), (0.30, 0.38, -0.06, 0.20, 0.0)),
        "right",
        SHOULDERS,
    )
    assert seen.position_in_map[1] > -0.08  # [m]


@pytest.mark.parametrize("patch", [(0.0, 0.22, -0.1, 0.2, 0.0), (-0.38, -0.30, -0.1, 0.2, 0.0)])
def test_cloth_on_the_chest_and_on_the_other_side_does_not_count(patch):
    with pytest.raises(PerceptionFailure):
        shoulder_seam(picture(patch), "right", SHOULDERS)


def test_beside_both_tapes_it_is_no_corner_of_the_back_panel_that_is_farther_headward():
    corner, sleeve = (0.34, 0.39, -0.20, 0.0, 0.0), (0.24, 0.40, -0.06, 0.2, 0.0)
    tapes = (0.26, 0.28, -0.06, 0.2, 0.0, MAGENTA), (0.19, 0.24, -0.06, -0.03, 0.0, NAVY)
    without = shoulder_seam(picture(corner, sleeve), "right", SHOULDERS)
    seen = shoulder_seam(picture(corner, sleeve, *tapes), "right", SHOULDERS)
    assert without.position_in_map[:2] == pytest.approx((0.365, -0.16), abs=0.04)
    assert seen.position_in_map[:2] == pytest.approx((0.31, -0.05), abs=0.04)


def test_by_its_tapes_it_is_found_above_the_height_of_the_arm():
    seen = shoulder_seam(
        picture(
            (0.26, 0.36, -0.05, 0.2, 0.09),
            (0.30, 0.32, -0.05, 0.2, 0.09, MAGENTA),
            (0.20, 0.26, -0.05, -0.02, 0.09, NAVY),
        ),
        "right",
        SHOULDERS,
    )
    assert seen.position_in_map == pytest.approx((0.30, -0.035, 1.09), abs=0.04)
