"""Renderer, primitive meshes and the seeded look of the room."""

import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.render.appearance import draw_appearance, gown_colours
from caretree.sim.render.camera import CAMERA_VIEWS, CLOTH_ID, Renderer, intrinsics_of, looking_at
from caretree.sim.render.raster import rasterise
from caretree.sim.render.solids import box_mesh, capsule_mesh, cylinder_mesh, join_meshes, sphere_mesh
from caretree.sim.scene.gown import GOWNS, build_gown


def volume(vertices, faces):
    """Signed volume: positive when every face is wound outwards."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float(np.sum(a * np.cross(b, c)) / 6)


@pytest.mark.parametrize(
    ("mesh", "expected"),
    [
        (box_mesh((-1, 0, 0), (1, 1, 3)), 6.0),
        (sphere_mesh((1, 2, 3), 0.5, 32), 4 / 3 * np.pi * 0.125),
        (capsule_mesh((0, 0, 0), (0, 1, 1), 0.2, 32), np.pi * 0.04 * np.sqrt(2) + 4 / 3 * np.pi * 0.008),
        (cylinder_mesh((0, 0, 0), (2, 0, 0), 0.1, 32), np.pi * 0.01 * 2),
    ],
)
def test_solids_are_closed_and_wound_outwards(mesh, expected):
    assert volume(*mesh) == pytest.approx(expected, rel=0.04)


def test_join_keeps_both():
    both = join_meshes([box_mesh((0, 0, 0), (1, 1, 1)), box_mesh((2, 0, 0), (3, 1, 1))])
    assert volume(*both) == pytest.approx(2.0)


def test_looking_at_is_a_proper_optical_frame():
    pose = looking_at((1.0, -0.3, 1.6), (0.0, -0.3, 0.7))
    np.testing.assert_allclose(pose[:3, :3].T @ pose[:3, :3], np.eye(3), atol=1e-12)
    assert np.linalg.det(pose[:3, :3]) == pytest.approx(1.0)
    assert pose[2, 1] < 0  # y of the image points down in the room
    assert pose[:3, 0] @ (0, 0, 1) == pytest.approx(0.0)


def test_bodies_move_and_names_are_checked():
    look = draw_appearance(np.random.default_rng(0))
    renderer = Renderer(look.light)
    renderer.add_rigid("ball", *sphere_mesh((0, 0, 0), 0.1), (255, 0, 0))
    camera = looking_at((1.5, 0.0, 1.0), (0.0, 0.0, 1.0))
    assert (renderer.render(camera).ids == -1).all()
    pose = np.eye(4)
    pose[:3, 3] = (0, 0, 1)
    renderer.set_pose("ball", pose)
    picture = renderer.render(camera)
    assert picture.ids[240, 320] == renderer.ids["ball"]
    assert picture.depth[240, 320] == pytest.approx(1.4, abs=0.01)
    with pytest.raises(CaretreeError, match="no body 'cube', only ball"):
        renderer.set_pose("cube", pose)
    with pytest.raises(CaretreeError, match="already"):
        renderer.add_rigid("ball", *sphere_mesh((0, 0, 0), 0.1), (255, 0, 0))


def test_far_sides_are_left_out_only_where_nobody_sees_them():
    renderer = Renderer(draw_appearance(np.random.default_rng(0)).light)
    sheet = np.array(((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)), float)
    renderer.add_rigid("ball", *sphere_mesh((0, 0, 1), 0.2), (255, 0, 0))
    renderer.add_rigid("sheet", sheet, np.array(((0, 1, 2), (0, 2, 3))), (0, 255, 0))
    size, lens = (64, 48), intrinsics_of((64, 48))
    for away in (0.0, 0.15, 0.21, 0.24, 1.0):  # inside of the ball, cut open by the near plane, and outside
        pose = looking_at(np.array((away, 0.0, 1.0)), np.array((-1.0, 0.0, 1.0)))
        whole = rasterise(renderer.triangles(), renderer.light, lens, pose, size)
        drawn = renderer.render(pose, size, lens)
        assert (drawn.ids == renderer.ids["ball"]).any()
        for picture in ("rgb", "depth", "ids", "cosine"):
            assert (getattr(drawn, picture) == getattr(whole, picture)).all()
    below = renderer.render(looking_at((0.0, 0.0, -1.0), (0.0, 0.0, 0.0)), size, lens)
    assert below.ids[24, 32] == renderer.ids["sheet"]


def test_cloth_moves_and_shows_two_sides():
    look = draw_appearance(np.random.default_rng(1))
    gown = build_gown(GOWNS["medium"])
    renderer = Renderer(look.light)
    renderer.set_cloth(gown.vertices + np.array((0, 0, 1.7)), gown.faces, *gown_colours(gown, look))
    outside = renderer.render(looking_at((0, 1.5, 1.2), (0, 0, 1.2)))
    inside = renderer.render(looking_at((0, -1.5, 1.2), (0, 0, 1.2)))
    for picture in (outside, inside):
        assert (picture.ids == CLOTH_ID).mean() > 0.2
    blueness = [np.ptp(p.rgb[p.ids == CLOTH_ID].astype(int), axis=1).mean() for p in (outside, inside)]
    assert blueness[0] > 1.5 * blueness[1]
    renderer.move_cloth(gown.vertices + np.array((0, 0, 30)))
    assert not (renderer.render(looking_at((0, 1.5, 1.2), (0, 0, 1.2))).ids == CLOTH_ID).any()


def test_look_is_seeded_and_varies():
    a, b, c = (draw_appearance(np.random.default_rng(s)) for s in (3, 3, 4))
    assert a.colours == b.colours
    assert a.colours["collar"] != c.colours["collar"]
    assert 0.7 <= c.light.intensity <= 1.2


def test_robot_cameras_deliver_their_size():
    look = draw_appearance(np.random.default_rng(0))
    renderer = Renderer(look.light)
    renderer.add_rigid("ball", *sphere_mesh((0, 0, 1), 0.2), (255, 0, 0))
    pose = looking_at((1.0, 0.0, 1.0), (0.0, 0.0, 1.0))
    for camera, ((width, height), _) in CAMERA_VIEWS.items():
        rgb, depth = renderer.photograph(camera, pose, np.random.default_rng(0))
        assert rgb.shape == (height, width, 3)
        assert depth.shape == (height, width)
        assert depth.dtype == np.float32
        assert depth[height // 2, width // 2] == pytest.approx(0.8, abs=0.01)


def test_field_of_view():
    fx, _, cx, _ = intrinsics_of((320, 240))
    assert np.rad2deg(2 * np.arctan((cx + 0.5) / fx)) == pytest.approx(69.0)
