import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.obj_file import read_obj, write_obj


def test_a_bad_mesh_is_refused_before_pybullet_hangs_on_it(tmp_path):
    for text, words in (
        ("v 0 0 0\nf 1 2 3\n", "a face names vertex 3"),
        ("", "the mesh is empty"),
        ("v a b c\n", "row 1"),
    ):
        (tmp_path / "bad.obj").write_text(text)
        with pytest.raises(CaretreeError, match=words):
            read_obj(tmp_path / "bad.obj")


def test_stays_are_springs_and_no_cloth(tmp_path):
    vertices = np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)])
    write_obj(tmp_path / "sewn.obj", vertices, np.array([(0, 1, 2), (1, 3, 2)]), np.array([(0, 1, 3)]))
    read, faces, stays = read_obj(tmp_path / "sewn.obj")
    assert np.allclose(read, vertices)
    assert faces.tolist() == [[0, 1, 2], [1, 3, 2]]
    assert stays.tolist() == [[0, 1, 3]]
