import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.obj_file import write_obj
from caretree.sim.scene.objects import Box, MeshObject, Sheet, UrdfObject, placed, sheet_mesh

AT = (1.0, 0.5, 0.7)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Box(name="", size=(1, 1, 1), position_in_map=AT), "'' is no name for an object"),
        (lambda: Box(name="a b", size=(1, 1, 1), position_in_map=AT), "is no name for an object"),
        (lambda: Box(name="box", size=(1, 0, 1), position_in_map=AT), "size is .* from 0.001 to 10"),
        (lambda: Box(name="box", size=(1, 1), position_in_map=AT), "size is .* 3 numbers"),
        (lambda: Box(name="box", size=(1, 1, 1), position_in_map=(0, 0, np.nan)), "position_in_map is"),
        (lambda: Box(name="box", size=(1, 1, 1), position_in_map=AT, mass=-1.0), "mass is -1.0"),
        (lambda: Box(name="box", size=(1, 1, 1), position_in_map=AT, stiffness=0.0), "stiffness is 0.0"),
        (lambda: MeshObject(name="cup", file="gone.obj", position_in_map=AT), "object 'cup': gone.obj: no such file"),
        (lambda: UrdfObject(name="chair", file="gone.urdf", position_in_map=AT), "gone.urdf is not there"),
        (lambda: Sheet(name="towel", size=(5.0, 5.0), position_in_map=AT), "1 to 2000 of them are asked for"),
        (lambda: Sheet(name="towel", size=(0.4, 0.6), position_in_map=AT, hung_by=(0.5, 2.0)), "hung_by is"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(make, words):
    with pytest.raises(CaretreeError, match=words):
        make()


def test_a_mesh_comes_from_its_file(tmp_path):
    corners = np.array([(0.0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)])
    write_obj(tmp_path / "cup.obj", corners, np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]))
    vertices, faces = MeshObject(name="cup", file=tmp_path / "cup.obj", position_in_map=AT).mesh()
    assert np.allclose(vertices, corners)
    assert len(faces) == 4


def test_a_sheet_lies_where_it_is_put_and_hangs_by_the_place_that_is_named():
    flat = Sheet(name="towel", size=(0.4, 0.6), position_in_map=AT, yaw=np.pi / 2)
    lying = placed(flat, sheet_mesh(flat).vertices)
    assert np.allclose(lying.mean(axis=0), AT)
    assert np.allclose(np.ptp(lying, axis=0), (0.6, 0.4, 0.0))
    hung = Sheet(name="towel", size=(0.4, 0.6), position_in_map=AT, hung_by=(0.5, 0.0))
    hanging = placed(hung, sheet_mesh(hung).vertices)
    assert np.allclose(np.ptp(hanging, axis=0), (0.4, 0.0, 0.6))
    assert hanging[:, 2].max() == pytest.approx(AT[2])
    assert np.linalg.norm(hanging - AT, axis=1).min() < 1e-9


def test_a_sheet_covers_its_area():
    mesh = sheet_mesh(Sheet(name="towel", size=(0.4, 0.6), position_in_map=AT))
    a, b, c = mesh.vertices[mesh.faces.T]
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2 == pytest.approx(0.24)
