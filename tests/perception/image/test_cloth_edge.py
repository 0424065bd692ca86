"""The upper edge of a cloth on a bed, against what was drawn."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.image.cloth_edge import cloth_edge
from caretree.sim.world import Frame

CLOTH, BED = (194, 218, 240), (236, 235, 226)
BED_TOP = 0.6  # [m]
CORNERS = np.array(((-0.5, -1.0, BED_TOP), (0.5, 1.0, BED_TOP)))
HIGH = 2.6  # of the camera [m]


def picture(*, camera_x=0.8, edge=0.2, slope=0.0, end=0.9, fallen=None, body=None):
    """A cloth from `edge` (at x = 0, more by `slope`) down to `end`, over a body or not, from above; 1 mm of noise."""
    rows, columns = np.mgrid[:240, :320]
    f, rng = 250.0, np.random.default_rng(4)
    away = HIGH - BED_TOP
    x, y = camera_x + (columns - 160) / f * away, -(rows - 120) / f * away
    cloth = (y > edge + slope * x) & (y < end) & (np.abs(x) < 0.45)
    height = np.full(cloth.shape, BED_TOP)
    if body is not None:  # from its side at `body`, 0.15 m high, the cloth slopes down over 0.1 m
        height += 0.15 * np.clip(1.0 - (np.abs(x) - body) / 0.1, 0.0, 1.0)
    if fallen is not None:
        height[cloth & (y < fallen)] = 0.1
    return Frame(
        camera="head",
        stamp=2.0,
        rgb=np.where(cloth[..., None], np.array(CLOTH, np.uint8), np.array(BED, np.uint8)),
        depth=(HIGH - height + 0.001 * rng.standard_normal(cloth.shape)).astype(np.float32),
        intrinsics=(f, f, 160.0, 120.0),
        pose_camera_in_map=np.array(
            ((1.0, 0, 0, camera_x), (0, -1.0, 0, 0), (0, 0, -1.0, HIGH), (0, 0, 0, 1.0)), dtype=float
        ),
    )


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("slope", [0.0, 0.3])
def test_it_is_the_edge_nearest_to_the_head_on_the_cameras_side(side, slope):
    point = cloth_edge(picture(camera_x=0.8 * side, slope=slope), CORNERS)
    x, y, z = point.position_in_map
    assert 0.15 < side * x < 0.35
    assert y == pytest.approx(0.2 + slope * x, abs=0.025)
    assert z == pytest.approx(BED_TOP, abs=0.02)
    assert point.approach_in_map == pytest.approx((0.0, 0.0, -1.0))
    assert abs(point.closing_in_map[1]) == pytest.approx(1.0), "across the edge"


@pytest.mark.parametrize("body", [0.12, 0.18])
def test_it_is_taken_where_it_slopes_down_beside_the_body(body):
    x, _, z = cloth_edge(picture(body=body), CORNERS).position_in_map
    assert z == pytest.approx(BED_TOP + 0.03, abs=0.025)
    assert x == pytest.approx(body + 0.08, abs=0.025)


def test_what_fell_off_the_bed_is_no_edge():
    assert cloth_edge(picture(fallen=0.4), CORNERS).position_in_map[1] > 0.38


def test_no_cloth_on_the_bed_is_told():
    with pytest.raises(PerceptionFailure):
        cloth_edge(picture(edge=0.95), CORNERS)
