"""The gown on top of an arm, from pictures painted by hand."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.sleeve.cloth_on_arm import cloth_on_arm
from caretree.sim.world import Frame

from .test_armhole_front import lower
from .test_worn_sleeve import ARM, DOWN

PRINTED = (110, 170, 215)  # the outside of the gown


def picture(columns, rows=(40, 80), ridge=None, height=0.05):
    """A camera 1 m above printed cloth, 5 mm a pixel, with a ridge at the columns (from, to) that is higher [m]."""
    rgb, depth = np.full((120, 160, 3), 128, np.uint8), np.ones((120, 160), np.float32)
    rgb[rows[0] : rows[1], columns[0] : columns[1]] = PRINTED
    if ridge is not None:
        depth[rows[0] : rows[1], ridge[0] : ridge[1]] -= height
    return Frame(
        camera="head", stamp=1.0, rgb=rgb, depth=depth, intrinsics=(200.0, 200.0, 80.0, 60.0), pose_camera_in_map=DOWN
    )


def test_it_is_taken_where_a_fold_is_highest_above_the_arm():
    flat = cloth_on_arm(picture((25, 60)), "right", lower(ARM))
    folded = cloth_on_arm(picture((25, 60), ridge=(44, 50)), "right", lower(ARM))
    assert folded.position_in_map[2] == pytest.approx(flat.position_in_map[2] + 0.05, abs=0.01)  # [m]
    assert folded.position_in_map[0] == pytest.approx(-0.17, abs=0.03)  # [m]
    assert folded.target == "sleeve_right"
    assert folded.approach_in_map[2] < -0.7, "from above"


@pytest.mark.parametrize(
    ("columns", "rows", "arm"),
    [((25, 60), (100, 118), lower(ARM)), ((70, 100), (40, 80), lower(ARM)), ((25, 60), (40, 80), lower(ARM, by=-0.06))],
)
def test_cloth_beside_the_upper_arm_beyond_it_or_under_it_does_not_count(columns, rows, arm):
    with pytest.raises(PerceptionFailure):
        cloth_on_arm(picture(columns, rows), "right", arm)
