"""The rasteriser against geometry that can be worked out by hand."""

import numpy as np
import pytest
from caretree.sim.render import raster
from caretree.sim.render.raster import Light, Triangles, rasterise

LIGHT = Light(direction_in_map=np.array((0.0, 0.0, -1.0)))
INTRINSICS = (200.0, 200.0, 79.5, 59.5)
SIZE = (160, 120)


def quad(corners, front=(200, 0, 0), back=(0, 200, 0), body=7, printed=False):
    """Two triangles; the front is the side from which the corners run anticlockwise."""
    return Triangles(
        vertices=np.array(corners, dtype=float),
        faces=np.array([(0, 1, 2), (0, 2, 3)]),
        front=np.tile(np.array(front, float), (2, 1)),
        back=np.tile(np.array(back, float), (2, 1)),
        ids=np.full(2, body, dtype=np.int32),
        uv=np.array(corners, dtype=float)[:, :2],
        printed=np.full(2, printed),
    )


def both(a, b):
    n = len(a.vertices)
    return Triangles(
        vertices=np.vstack([a.vertices, b.vertices]),
        faces=np.vstack([a.faces, b.faces + n]),
        front=np.vstack([a.front, b.front]),
        back=np.vstack([a.back, b.back]),
        ids=np.concatenate([a.ids, b.ids]),
        uv=np.vstack([a.uv, b.uv]),
        printed=np.concatenate([a.printed, b.printed]),
    )


SQUARE = [(-0.2, -0.1, 1.0), (0.2, -0.1, 1.0), (0.2, 0.1, 1.0), (-0.2, 0.1, 1.0)]  # y is down: this is the back side


def test_square_lands_on_the_pixels_of_the_pinhole_model():
    picture = rasterise(quad(SQUARE), LIGHT, INTRINSICS, np.eye(4), SIZE)
    rows, columns = np.nonzero(picture.ids == 7)
    # 200 px/m at 1 m: columns 79.5 +- 40, rows 59.5 +- 20
    assert (columns.min(), columns.max()) == (40, 119)
    assert (rows.min(), rows.max()) == (40, 79)
    assert len(rows) == 80 * 40
    np.testing.assert_allclose(picture.depth[rows, columns], 1.0, atol=1e-6)


@pytest.mark.parametrize("flip", [False, True])
def test_the_two_sides_have_their_own_colours(flip):
    corners = SQUARE[::-1] if flip else SQUARE
    picture = rasterise(quad(corners), LIGHT, INTRINSICS, np.eye(4), SIZE)
    red, green = picture.rgb[60, 80, 0], picture.rgb[60, 80, 1]
    assert (red > 100) == flip
    assert (green > 100) == (not flip)


def test_depth_of_a_slanted_plane_is_exact():
    # plane z = 1 + x
    corners = [(-0.3, -0.3, 0.7), (0.3, -0.3, 1.3), (0.3, 0.3, 1.3), (-0.3, 0.3, 0.7)]
    picture = rasterise(quad(corners), LIGHT, INTRINSICS, np.eye(4), SIZE)
    rows, columns = np.nonzero(picture.depth)
    slope = (columns - INTRINSICS[2]) / INTRINSICS[0]
    np.testing.assert_allclose(picture.depth[rows, columns], 1 / (1 - slope), rtol=1e-5)


def test_the_nearer_surface_wins_in_either_order():
    near = quad([(x, y, 0.8) for x, y, _ in SQUARE], body=1)
    far = quad(SQUARE, body=2)
    for scene in (both(near, far), both(far, near)):
        assert rasterise(scene, LIGHT, INTRINSICS, np.eye(4), SIZE).ids[60, 80] == 1


def test_a_floor_under_the_camera_is_clipped_not_lost():
    floor = quad([(-5, 0.5, -5), (5, 0.5, -5), (5, 0.5, 5), (-5, 0.5, 5)])  # half a metre below, also behind
    picture = rasterise(floor, LIGHT, INTRINSICS, np.eye(4), SIZE)
    rows = np.arange(90, 120)
    np.testing.assert_allclose(picture.depth[90:, 80], 0.5 * 200 / (rows - 59.5), rtol=1e-4)
    assert not picture.depth[:60].any()


def test_camera_pose_is_taken_as_camera_in_map():
    pose = np.eye(4)
    pose[:3, 3] = (0.1, 0.0, -1.0)  # back off by 1 m and move right by 0.1 m
    picture = rasterise(quad(SQUARE), LIGHT, INTRINSICS, pose, SIZE)
    rows, columns = np.nonzero(picture.depth)
    np.testing.assert_allclose(picture.depth[rows, columns], 2.0, atol=1e-5)
    assert columns.mean() == pytest.approx(79.5 - 10, abs=0.6)


def test_print_shows_on_the_front_only():
    front = rasterise(quad(SQUARE[::-1], printed=True), LIGHT, INTRINSICS, np.eye(4), SIZE)
    back = rasterise(quad(SQUARE, printed=True), LIGHT, INTRINSICS, np.eye(4), SIZE)
    assert len(np.unique(front.rgb[45:75, 45:115, 0])) == 2
    assert len(np.unique(back.rgb[45:75, 45:115, 1])) == 1


def any_triangles(rng, size):
    """Some that are wide, slivers, or reach behind the camera."""
    corners = rng.normal(size=(8, 3, 3)) * size + (0.0, 0.0, 1.0)
    corners[0, 2] = corners[0, :2].mean(axis=0) + rng.normal(size=3) * 1e-6
    return Triangles(
        vertices=corners.reshape(-1, 3),
        faces=np.arange(24).reshape(8, 3),
        front=rng.uniform(0, 255, (8, 3)),
        back=rng.uniform(0, 255, (8, 3)),
        ids=np.arange(8, dtype=np.int32),
        uv=rng.normal(size=(24, 2)),
        printed=np.arange(8) % 2 == 0,
    )


@pytest.mark.parametrize("size", [0.1, 0.7, 5.0, 300.0])
def test_no_pixel_of_a_wide_triangle_is_left_out(monkeypatch, size):
    """Rows are drawn from where the triangle begins in them; drawn by the whole box, the picture is the same."""
    rng = np.random.default_rng(6)
    scenes = [any_triangles(rng, size) for _ in range(3)]
    by_rows = [rasterise(scene, LIGHT, (60.0, 60.0, 31.5, 23.5), np.eye(4), (64, 48)) for scene in scenes]
    monkeypatch.setattr(raster, "WIDE", 10**9)
    monkeypatch.setattr(raster, "_draw", raster._draw.py_func)
    for scene, seen in zip(scenes, by_rows, strict=True):
        whole = rasterise(scene, LIGHT, (60.0, 60.0, 31.5, 23.5), np.eye(4), (64, 48))
        assert (whole.ids >= 0).any()
        np.testing.assert_array_equal(seen.ids, whole.ids)
        np.testing.assert_array_equal(seen.depth, whole.depth)
        np.testing.assert_array_equal(seen.rgb, whole.rgb)
