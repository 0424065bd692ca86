"""Between pixels and points: there and back, and what is out of view."""

import numpy as np
import pytest
from caretree.perception.image.projection import pixel_scale, pixels_of, points_in_map, project
from caretree.sim.render.camera import looking_at
from caretree.sim.world import Frame

POSE = looking_at(np.array((0.7, -0.3, 1.6)), np.array((-0.2, 0.1, 0.7)))


def picture(depth, focal=200.0):
    height, width = depth.shape
    return Frame(
        camera="head",
        stamp=1.0,
        rgb=np.zeros((height, width, 3), np.uint8),
        depth=depth.astype(np.float32),
        intrinsics=(focal, focal, width / 2, height / 2),
        pose_camera_in_map=POSE,
    )


def test_every_point_falls_on_its_own_pixel():
    frame = picture(np.random.default_rng(0).uniform(0.3, 3.0, (40, 60)))
    points = points_in_map(frame)
    u, v, z = project(frame, points.reshape(-1, 3)).T
    rows, columns = np.indices((40, 60))
    np.testing.assert_allclose(u, columns.ravel(), atol=1e-6)
    np.testing.assert_allclose(v, rows.ravel(), atol=1e-6)
    np.testing.assert_allclose(z, frame.depth.ravel(), atol=1e-6)
    seen = pixels_of(frame, points[5:30, 5:50].reshape(-1, 3))
    assert seen.inside.all()
    assert (seen.rows.reshape(25, 45) == rows[5:30, 5:50]).all()
    assert (seen.columns.reshape(25, 45) == columns[5:30, 5:50]).all()


def test_no_depth_is_no_point():
    depth = np.ones((4, 6))
    depth[2, 3] = 0.0
    assert np.isnan(points_in_map(picture(depth))[2, 3]).all()
    assert np.isnan(points_in_map(picture(depth))).any(axis=2).sum() == 1


@pytest.mark.parametrize(
    ("place", "inside"),
    [((0, 0, 1), True), ((0, 0, -1), False), ((0, 0, 0.04), False), ((0.2, 0, 1), False), ((0, -0.2, 1), False)],
)
def test_points_behind_beside_or_at_the_lens_are_out_of_view(place, inside):
    frame = picture(np.ones((40, 60)))
    seen = pixels_of(frame, POSE[:3, 3] + POSE[:3, :3] @ np.array(place, float))
    assert seen.inside.tolist() == [inside]
    assert seen.depth[0] == pytest.approx(place[2])
    assert (seen.rows[0], seen.columns[0]) == ((20, 30) if inside else (0, 0))


def test_pixels_count_more_in_a_larger_picture():
    small, large = (pixel_scale(picture(np.ones((4, 6)), focal)) for focal in (233.0, 932.0))
    assert (small, large) == pytest.approx((0.5, 2.0))
