import numpy as np
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import urdf, visual
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.robot.ur5_pair import UR5_PAIR
from caretree.sim.robot.urdf_parts import with_collisions


def test_every_mesh_belongs_to_a_link_and_is_light():
    meshes = visual.visual_meshes()
    poses = kinematics_of(BAXTER).link_poses(np.zeros(kinematics_of(BAXTER).model.nq))
    assert set(meshes) <= set(poses)
    assert {"base", "torso", "left_wrist", "right_finger_a_link"} <= set(meshes)
    for vertices, faces, rgb in meshes.values():
        assert len(faces) <= 600
        assert faces.min() >= 0
        assert faces.max() < len(vertices)
        assert np.isfinite(vertices).all()
        assert all(0.0 <= value <= 1.0 for value in rgb)


def test_another_robot_looks_as_it_collides():
    meshes = visual.meshes_of(UR5_PAIR)
    assert set(UR5_PAIR.shapes) <= set(meshes)
    vertices, faces, _ = meshes["left_forearm_link"]
    shape = UR5_PAIR.shapes["left_forearm_link"][0]
    radius, length = shape.size
    np.testing.assert_allclose(np.ptp(vertices, axis=0), (2 * radius, 2 * radius, length + 2 * radius), atol=0.005)
    assert faces.max() < len(vertices)


def test_hulls_keep_the_size_of_the_originals_and_face_outwards():
    vertices, _ = visual._read_mesh("upper_elbow/E0.DAE")
    hull, faces, _ = visual.visual_meshes()["left_upper_elbow"]
    np.testing.assert_allclose(hull.min(axis=0), vertices.min(axis=0), atol=0.01)
    np.testing.assert_allclose(hull.max(axis=0), vertices.max(axis=0), atol=0.01)
    a, b, c = (hull[faces[:, k]] for k in range(3))
    assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0.0  # positive volume: outward winding


def test_a_damaged_cache_is_built_again(tmp_path, monkeypatch):
    monkeypatch.setattr(visual, "cache_folder", lambda: tmp_path)
    path = tmp_path / f"robot_visual_{visual._VERSION}.npz"
    path.write_bytes(b"not a zip file")
    assert visual._load(path) is None
    assert not path.exists()


def test_urdf_is_written_once_and_whole(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    urdf.urdf_path.cache_clear()
    try:
        path = urdf.urdf_path(BAXTER)
        assert path.is_relative_to(tmp_path)
        assert path.read_text() == with_collisions(urdf.compose(), BAXTER.shapes)
        assert [file.name for file in path.parent.iterdir()] == [path.name]
    finally:
        urdf.urdf_path.cache_clear()
