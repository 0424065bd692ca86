import numpy as np
import pytest
import yaml
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study


def edit(folder, **changes):
    file = folder / "measurement.yaml"
    file.write_text(yaml.safe_dump({**yaml.safe_load(file.read_text()), **changes}))


def test_roles_are_split_by_episode_when_the_file_gives_none(axis_set):
    folder = axis_set(episodes=4)
    edit(folder, episodes=[{"file": f"e{k}.csv"} for k in range(4)])
    measured = load_set(folder)
    assert [e.role for e in measured.episodes] == ["fit", "fit", "fit", "heldout"]


def test_phases_reach_every_episode(axis_set):
    folder = axis_set()
    edit(folder, phases=[{"name": "reach", "t0": 0.0, "t1": 3.0}])
    assert all(e.phases[0].name == "reach" for e in load_set(folder).episodes)


def test_notes_of_any_other_name_may_stand_in_a_set(axis_set):
    folder = axis_set()
    edit(folder, name="drawer", source="lab", description="pulled by hand")
    assert load_set(folder).settings["name"] == "drawer"


def jump(folder, row):
    """A clock that is set right in the middle of a log."""
    lines = (folder / "e1.csv").read_text().splitlines()
    for k in range(row + 1, len(lines)):
        t, rest = lines[k].split(",", 1)
        lines[k] = f"{float(t) + 1.7e9!r},{rest}"
    (folder / "e1.csv").write_text("\n".join(lines))


def edit_text(folder, line):
    file = folder / "measurement.yaml"
    text = file.read_text()
    assert "mass: " in text
    file.write_text("\n".join(line if x.startswith("mass: ") else x for x in text.splitlines()))


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda f: edit(f, masss=2.0), ("measurement.yaml", "there is no setting 'masss', did you mean mass?")),
        (
            lambda f: edit(f, episodes=[{"file": "e0.csv"}, {"file": "e1.csv", "rolle": "heldout"}]),
            ("measurement.yaml", "there is no setting 'rolle' of episode e1.csv, did you mean role?"),
        ),
        (
            lambda f: (f / "measurement.yaml").write_text("system: axis\nmass: 1\nmass: 2\n"),
            ("measurement.yaml", "row 3", "'mass' is given twice"),
        ),
        (
            lambda f: edit(f, friction_of_rail=2.0),
            ("measurement.yaml", "there is no setting 'friction_of_rail'", "(there are system, episodes"),
        ),
        (
            lambda f: edit(f, episodes=[{"file": "e0.csv"}, {"file": "e1.csv", "type": "heldout"}]),
            ("measurement.yaml", "there is no setting 'type' of episode e1.csv", "file, role"),
        ),
        (lambda f: edit(f, mass=10**400), ("mass is 1000", "a positive number")),
        (lambda f: edit(f, phases={"reach": 3}), ("`phases` must list",)),
        (lambda f: edit(f, phases=[{"name": "reach", "t2": 3}]), ("there is no setting 't2' of a phase",)),
        (
            lambda f: (f / "measurement.yaml").write_text("mass: " + "9" * 5000),
            ("measurement.yaml", "Exceeds the limit"),
        ),
        (lambda f: edit(f, system="boat"), ("measurement.yaml", "system is 'boat'", "arm, axis, fall, cloth")),
        (lambda f: edit(f, episodes=[{"file": "e0.csv"}]), ("measurement.yaml", "one episode only")),
        (lambda f: edit(f, episodes=[{"file": "e0.csv"}, {"file": "gone.csv"}]), ("gone.csv", "no such file")),
        (lambda f: edit(f, mass=-2), ("mass is -2", "positive")),
        (lambda f: (f / "measurement.yaml").write_text(""), ("measurement.yaml", "empty")),
        (lambda f: (f / "measurement.yaml").write_text("a: [1"), ("measurement.yaml", "row", "not YAML")),
        (lambda f: (f / "measurement.yaml").write_bytes(b"mass: \xff\xfe"), ("measurement.yaml", "not UTF-8")),
        (lambda f: (f / "e1.csv").write_text(""), ("e1.csv", "empty")),
        (lambda f: (f / "e1.csv").write_text("t,q,dq,force\n0,1,2,3\n"), ("e1.csv", "1 rows of data", "at least 12")),
        (lambda f: (f / "e1.csv").write_bytes(b"t,q\n" + bytes(range(256)) * 40), ("e1.csv",)),
        (lambda f: replace_cell(f, 5, 3, "nan"), ("e1.csv", "column 'force'", "row 6", "nan")),
        (lambda f: replace_cell(f, 7, 1, "x"), ("e1.csv", "column 'q'", "row 8", "'x'")),
        (lambda f: replace_cell(f, 9, 0, "-1"), ("e1.csv", "column 't'", "row 10", "does not increase")),
        (lambda f: replace_cell(f, 4, 3, "1,2"), ("e1.csv", "row 5", "5 cells", "4 columns")),
        (lambda f: replace_cell(f, 0, 3, "torque"), ("e1.csv", "column 'force' is missing", "row 1")),
        (lambda f: scale(f, 1, 1000.0), ("e1.csv", "column 'q'", "row", "metres")),
        (lambda f: scale(f, 0, 1000.0), ("e1.csv", "column 't'", "seconds")),
        (lambda f: jump(f, 100), ("e1.csv", "column 't', row 102 jumps by 1.7e+09 s", "as two episodes")),
        (lambda f: edit_text(f, "mass: 1e13"), ("mass is 10000000000000.0", "a positive number below 1e+12")),
        (lambda f: (f / "measurement.yaml").write_text("[system, axis]"), ("the file holds ['system', 'axis']",)),
        (lambda f: scale(f, 2, 1000.0), ("e1.csv", "column 'dq'", "row", "the slope of 'q'", "metres per second")),
        (lambda f: scale(f, 3, 1e9), ("e1.csv", "column 'force'", "row", "in N")),
    ],
)
def test_bad_input_is_one_sentence_with_file_column_and_row(axis_set, spoil, words):
    folder = axis_set()
    spoil(folder)
    with pytest.raises(GapError) as caught:
        open_study(load_set(folder)).find()
    text = str(caught.value)
    assert "\n" not in text
    assert all(w in text for w in words), text


def replace_cell(folder, row, column, text):
    file = folder / "e1.csv"
    lines = [line.split(",") for line in file.read_text().splitlines()]
    lines[row][column] = text
    file.write_text("\n".join(",".join(line) for line in lines))


def scale(folder, column, factor):
    file = folder / "e1.csv"
    data = np.loadtxt(file, delimiter=",", skiprows=1)
    data[:, column] *= factor
    np.savetxt(file, data, delimiter=",", header="t,q,dq,force", comments="")
