"""Where a hung cloth is taken, against what was drawn."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.image.hung_cloth import hung_cloth
from caretree.sim.world import Frame

CLOTH, WALL = (194, 218, 240), (236, 235, 226)
POSE = np.array(((1.0, 0, 0, 0.2), (0, 0, 1.0, -0.5), (0, -1.0, 0, 1.4), (0, 0, 0, 1.0)))  # looks along y


def picture(*, top=1.5, x=0.3, away=0.8, colour=CLOTH):
    """A cloth that hangs from a point, as a strip that widens downwards, before a wall; 1 mm of noise."""
    rows, columns = np.mgrid[:240, :320]
    f, rng = 250.0, np.random.default_rng(4)
    across, height = 0.2 + (columns - 160) / f * away, 1.4 - (rows - 120) / f * away
    strip = (height < top) & (height > top - 0.4) & (np.abs(across - x) < 0.02 + 0.15 * (top - height))
    depth = np.where(strip, away, 3.0) + 0.001 * rng.standard_normal(strip.shape)
    return Frame(
        camera="head",
        stamp=2.0,
        rgb=np.where(strip[..., None], np.array(colour, np.uint8), np.array(WALL, np.uint8)),
        depth=depth.astype(np.float32),
        intrinsics=(f, f, 160.0, 120.0),
        pose_camera_in_map=POSE,
    )


@pytest.mark.parametrize("x", [0.1, 0.3])
def test_it_is_taken_level_below_its_top(x):
    point = hung_cloth(picture(x=x))
    assert point.position_in_map == pytest.approx((x, 0.3, 1.44), abs=0.01)
    assert point.approach_in_map[2] == 0.0
    assert point.approach_in_map @ (x - 0.2, 0.8, 0.0) > 0.99 * np.hypot(x - 0.2, 0.8)
    assert abs(point.closing_in_map[2]) < 1e-9
    assert abs(point.closing_in_map @ point.approach_in_map) < 1e-9


def test_no_cloth_is_told():
    with pytest.raises(PerceptionFailure):
        hung_cloth(picture(colour=WALL))
