"""The side of a hung gown, from pictures painted by hand."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.gown.hung_side import hung_side
from caretree.sim.world import Frame

LEVEL = np.array(((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 1.0, -1.0), (0.0, -1.0, 0.0, 1.3), (0.0, 0.0, 0.0, 1.0)))
NAVY, PRINTED, PLAIN = (20, 34, 92), (118, 172, 219), (194, 219, 240)


def picture(fabric, below=None, strips=True):
    """A level camera 1 m before a gown on its hook, 5 mm a pixel: two strips of tape fall apart, fabric between them.

    `below`: colour of the rows that are far below the hook.
    """
    rgb = np.full((120, 160, 3), 128, np.uint8)
    for row in range(20, 115):
        half = min(50, row - 16)
        rgb[row, 80 - half : 80 + half] = fabric if row < 48 or below is None else below
    rgb[14:26, 76:84] = NAVY
    for row in range(20, 75) if strips else ():
        for middle in (80 - (row - 16), 80 + (row - 16)):
            rgb[row, max(0, middle - 5) : middle + 5] = NAVY
    depth = np.where((rgb == 128).all(axis=2), 2.0, 1.0).astype(np.float32)
    return Frame(
        camera="head", stamp=2.0, rgb=rgb, depth=depth, intrinsics=(200.0, 200.0, 80.0, 60.0), pose_camera_in_map=LEVEL
    )


@pytest.mark.parametrize(("fabric", "outside"), [(PRINTED, True), (PLAIN, False)])
def test_one_side_all_over_is_certain(fabric, outside):
    side = hung_side(picture(fabric))
    assert side.outside is outside
    assert side.confidence > 0.9
    assert side.stamp == 2.0


@pytest.mark.parametrize(("fabric", "below", "outside"), [(PRINTED, PLAIN, True), (PLAIN, PRINTED, False)])
def test_the_panel_below_the_hook_counts_more_than_the_rest(fabric, below, outside):
    mixed = hung_side(picture(fabric, below))
    assert mixed.outside is outside
    assert mixed.confidence < hung_side(picture(fabric)).confidence


def test_a_gown_without_a_neckline_below_its_hook_is_wrapped_round():
    side = hung_side(picture(PRINTED, strips=False))
    assert not side.outside
    assert side.confidence < 0.5


def test_no_gown(black):
    with pytest.raises(PerceptionFailure):
        hung_side(black)
