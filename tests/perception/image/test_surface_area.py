from types import SimpleNamespace

import numpy as np
import pytest
from caretree.perception.image.surface_area import surface_areas

CAMERA = SimpleNamespace(intrinsics=(200.0, 200.0, 100.0, 80.0), pose_camera_in_map=np.eye(4))


def sheet(tilt):
    """(n, 3) the points that pixels see of a sheet one metre ahead, turned by `tilt` [rad] about the vertical."""
    u, v = np.meshgrid(np.arange(-20, 20) / 200, np.arange(-20, 20) / 200)
    rays = np.stack([u, v, np.ones_like(u)], axis=-1).reshape(-1, 3)
    normal = np.array((np.sin(tilt), 0.0, -np.cos(tilt)))
    return rays * (normal @ (0, 0, 1) / (rays @ normal))[:, None]


@pytest.mark.parametrize("tilt", [0.0, 0.5, -1.0])
def test_the_areas_of_pixels_add_up_to_the_sheet_they_show(tilt):
    points = sheet(tilt)
    along = np.linalg.norm(points[:40][-1] - points[:40][0]) * 40 / 39
    edges = points.reshape(40, 40, 3)
    heights = np.linalg.norm(edges[-1] - edges[0], axis=-1) * 40 / 39
    assert surface_areas(CAMERA, points, 0.02, 0.1).sum() == pytest.approx(along * heights.mean(), rel=0.03)


def test_grazing_surfaces_are_not_believed_beyond_the_least_cosine():
    points = sheet(1.3)
    free, held = (surface_areas(CAMERA, points, 0.02, cosine) for cosine in (0.05, 0.5))
    assert held.sum() < 0.7 * free.sum()


def test_a_point_alone_counts_as_facing_the_camera():
    (area,) = surface_areas(CAMERA, np.array([(0.0, 0.0, 2.0)]), 0.02, 0.1)
    assert area == pytest.approx(2.0**2 / 200**2)
