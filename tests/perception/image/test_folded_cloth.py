"""Where a folded cloth is taken, against what was drawn."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.image.folded_cloth import folded_cloth
from caretree.sim.world import Frame

SIZE = (0.09, 0.025, 0.09)  # [m]
CLOTH, TABLE = (194, 218, 240), (150, 150, 150)
POSE = np.array(((1.0, 0, 0, 0), (0, -1.0, 0, 0), (0, 0, -1.0, 1.6), (0, 0, 0, 1.0)))  # straight down, 1.6 m up


def picture(yaw, at=(0.05, -0.02), table=0.7, colour=CLOTH):
    """A folded cloth on a table, seen from straight above by a camera with 1 mm of noise."""
    rows, columns = np.mgrid[:240, :320]
    fx, rng = 300.0, np.random.default_rng(3)
    top = table + SIZE[2]
    x, y = (columns - 160) / fx * (1.6 - top), -(rows - 120) / fx * (1.6 - top)
    along = (x - at[0]) * np.cos(yaw) + (y - at[1]) * np.sin(yaw)
    across = -(x - at[0]) * np.sin(yaw) + (y - at[1]) * np.cos(yaw)
    on_cloth = (np.abs(along) < SIZE[0] / 2) & (np.abs(across) < SIZE[1] / 2)
    rgb = np.where(on_cloth[..., None], np.array(colour, np.uint8), np.array(TABLE, np.uint8))
    depth = np.where(on_cloth, 1.6 - top, 1.6 - table) + 0.001 * rng.standard_normal(on_cloth.shape)
    return Frame(
        camera="head",
        stamp=2.0,
        rgb=rgb,
        depth=depth.astype(np.float32),
        intrinsics=(fx, fx, 160.0, 120.0),
        pose_camera_in_map=POSE,
    )


@pytest.mark.parametrize("yaw", [-0.5, 0.0, 0.3, 1.2])
def test_the_fingers_close_across_its_short_side(yaw):
    point = folded_cloth(picture(yaw))
    assert point.position_in_map[:2] == pytest.approx((0.05, -0.02), abs=0.004)
    assert 0.7 + SIZE[2] - 0.03 < point.position_in_map[2] < 0.7 + SIZE[2]
    assert abs(point.closing_in_map @ (-np.sin(yaw), np.cos(yaw), 0.0)) > np.cos(np.deg2rad(8.0))
    assert point.approach_in_map == pytest.approx((0.0, 0.0, -1.0))
    assert point.stamp == 2.0


def test_no_cloth_is_told():
    with pytest.raises(PerceptionFailure):
        folded_cloth(picture(0.0, colour=TABLE))
