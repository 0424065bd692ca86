from importlib.metadata import EntryPoint

import pytest
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.own import find_system as where
from caretree.learning.gap.own.find_system import absolute, find_system, installed

SOURCE = """
import numpy as np
from caretree.gap import Effect, Parameter, System


class Mine(System):
    name = "mine"
    channels = {"x": "m"}
    effects = (Effect(name="drift", parameters=(Parameter(name="rate", unit="m/s", typical=0.1),)),)

    def predict(self, log, values):
        return values["rate"] * log["t"]


class Half(System):
    name = "half"


class Fails(Mine):
    def __init__(self):
        raise ValueError("no licence\\nfound")
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "mine.py"
    path.write_text(SOURCE)
    return path


def test_a_class_in_a_file(file):
    assert find_system(f"{file}:Mine").name == "mine"


@pytest.mark.parametrize(
    ("class_name", "says"),
    [
        ("Yours", "there are Mine, Half, Fails"),
        ("np", "no class that derives"),
        ("Half", "Half has no predict"),
        ("Fails", "ValueError: no licence found"),
        ("", "must be path.py:Class"),
    ],
)
def test_a_class_that_is_none_is_one_sentence(file, class_name, says):
    with pytest.raises(GapError) as error:
        find_system(f"{file}:{class_name}")
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_a_file_that_cannot_be_imported_is_one_sentence(tmp_path):
    broken = tmp_path / "broken.py"
    broken.write_text("import nothing_like_this\n")
    with pytest.raises(GapError, match="ModuleNotFoundError"):
        find_system(f"{broken}:Mine")
    with pytest.raises(GapError, match="no such file"):
        find_system(f"{tmp_path / 'absent.py'}:Mine")


def test_an_installed_one_goes_by_its_name(monkeypatch):
    entry = EntryPoint("gripper", "example:Gripper", where.GROUP)
    monkeypatch.setattr(where, "entry_points", lambda group: [entry] if group == where.GROUP else [])
    assert set(installed()) == {"gripper"}
    with pytest.raises(GapError, match=r"caretree.gap_systems \(gripper\)"):
        find_system("griper")
    with pytest.raises(GapError, match="system gripper: ModuleNotFoundError"):
        find_system("gripper")


def test_the_place_of_a_file_is_kept_whole(file, monkeypatch):
    monkeypatch.chdir(file.parent)
    assert absolute("mine.py:Mine") == f"{file}:Mine"
    assert absolute("gripper") == "gripper"
