import numpy as np
import pytest
import yaml
from caretree.learning.gap.cloth.scene import read_scene
from caretree.learning.gap.measurement import load_set
from caretree.sim.errors import CaretreeError


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"mesh": "gone.obj"}, "gone.obj: no such file"),
        ({"markers": [0, 99]}, "`markers` must list vertex ids from 0 to 48"),
        ({"pins": [{"vertices": [70]}]}, "ids from 0 to 48"),
        ({"physics": {"mass": -1}}, "physics.mass is -1"),
        ({"capsules": [{"a": [0, 0, 0]}]}, "every capsule needs a, b"),
        ({"capsules": [{"a": [0, 0, 0], "b": [0, 0, 1], "radius": -1}]}, "positive radius"),
        ({"capsules": 3}, "every capsule needs a, b"),
        ({"physics": "soft"}, "`physics` is 'soft'"),
        ({"physics": {"gravity": "down"}}, "physics.gravity is 'down'"),
        ({"physics": {"gravity": [0, 0]}}, "physics.gravity is"),
        ({"physics": {"time_step": 0}}, "physics.time_step is 0"),
        ({"physics": {"mass": 0.1, "elastic_stiffness": 1e12}}, "need steps of"),
        ({"physics": {"mass": 0.001}}, "must weigh at least 0.009 kg"),
        ({"pins": "left"}, "`pins` is 'left'"),
        ({"pins": [{"vertices": [0], "release_t": "soon"}]}, "release_t of a pin is 'soon'"),
        ({"pins": [{"vertices": [0], "path": 7}]}, "path of a pin is 7"),
    ],
)
def test_a_set_that_does_not_fit_is_refused(cloth_set, change, words):
    file = cloth_set / "measurement.yaml"
    file.write_text(yaml.safe_dump({**yaml.safe_load(file.read_text()), **change}))
    with pytest.raises(CaretreeError, match=words):
        read_scene(load_set(cloth_set))


@pytest.mark.parametrize(
    ("column", "factor", "words"),
    [(0, 1000.0, "column 't' steps by 20, it must be in seconds"), (6, 1000.0, "column 'm1z', row 2 .* in metres")],
)
def test_numbers_in_a_wrong_unit_are_refused(cloth_set, column, factor, words):
    table = np.loadtxt(cloth_set / "e1.csv", delimiter=",", skiprows=1)
    header = (cloth_set / "e1.csv").read_text().splitlines()[0]
    table[:, column] *= factor
    np.savetxt(cloth_set / "e1.csv", table, delimiter=",", header=header, comments="")
    with pytest.raises(CaretreeError, match=words):
        read_scene(load_set(cloth_set))


def test_a_load_is_used_only_where_every_recording_has_one(cloth_set):
    assert read_scene(load_set(cloth_set))[1][0].load is not None
    lines = [line.rsplit(",", 3)[0] for line in (cloth_set / "e1.csv").read_text().splitlines()]
    (cloth_set / "e1.csv").write_text("\n".join(lines))
    assert [e.load for e in read_scene(load_set(cloth_set))[1]] == [None, None]
