import subprocess
import sys
from pathlib import Path

import pytest
from caretree.trees.cli import main


@pytest.fixture(autouse=True)
def in_an_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # another test in this process may have run a task of that name
    monkeypatch.delitem(sys.modules, "greet", raising=False)
    monkeypatch.setattr(sys, "path", [folder for folder in sys.path if not Path(folder, "greet.py").exists()])


def test_a_new_task_holds_runs_and_passes_its_tests(capsys):
    assert main(["new", "greet"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "greet.py",
        "test_greet.py",
        "next: caretree run greet.py --world scripted",
    ]
    assert main(["check", "greet.py"]) == 0
    assert main(["run", "greet.py", "--world", "scripted"]) == 0
    assert "success: The task is done." in capsys.readouterr().out
    # an own process, as a user would: its skills stay out of this one's registry, its rootdir is the folder
    tested = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "."], capture_output=True, text=True
    )
    assert tested.returncode == 0, tested.stdout
    assert "8 passed" in tested.stdout


def test_a_fault_at_any_skill_of_it_is_survived():
    assert main(["new", "nod", "--out", "deep/er"]) == 0
    assert main(["inject", "deep/er/nod.py", "--sample", "12"]) == 0


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("two words", "is no name for a task"),
        ("../up", "is no name for a task"),
        ("__main__", "is no name for a task"),
        ("class", "is no name for a task"),
        ("test_greet", "is no name for a task"),
        ("wave", "is a task of the package already"),
        ("random", "would stand in the way of Python's module 'random'"),
    ],
)
def test_a_name_that_will_not_do_is_refused(name, said, capsys):
    assert main(["new", name]) == 2
    assert said in capsys.readouterr().err
    assert list(Path().iterdir()) == []


def test_no_file_is_overwritten(capsys):
    Path("test_greet.py").write_text("mine")
    assert main(["new", "greet"]) == 2
    assert "test_greet.py is there already" in capsys.readouterr().err
    assert [path.name for path in Path().iterdir()] == ["test_greet.py"]
    assert Path("test_greet.py").read_text() == "mine"
