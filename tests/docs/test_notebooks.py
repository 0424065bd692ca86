"""The notebooks run as they stand, and what they show names no machine."""

import json
import runpy
import sys
from pathlib import Path

import matplotlib
import pytest
from caretree.skills.core.skill import Skill

FOLDER = Path(__file__).parents[2] / "docs/notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


@pytest.fixture
def executed(monkeypatch):
    """What runs a notebook; modules and skills of its cells are forgotten afterwards."""
    skills, modules, path = list(Skill.registry), set(sys.modules), list(sys.path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    with matplotlib.rc_context():
        yield runpy.run_path(str(FOLDER / "run_notebook.py"))["executed"]
    Skill.registry[:], sys.path[:] = skills, path
    for name in set(sys.modules) - modules:
        if name.startswith("caretree_task_"):
            del sys.modules[name]


def notebook(*sources):
    return {"cells": [{"cell_type": "code", "source": source.splitlines(keepends=True)} for source in sources]}


def test_there_are_two():
    assert [path.stem for path in NOTEBOOKS] == ["author_a_task", "close_a_gap"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_runs(path, executed, tmp_path):
    committed = json.loads(path.read_text(encoding="utf-8"))
    now = executed(committed, tmp_path)
    for before, after in zip(committed["cells"], now["cells"], strict=True):
        kinds = [output["output_type"] for output in after.get("outputs", ())]
        assert [output["output_type"] for output in before.get("outputs", ())] == kinds


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_what_is_committed_names_no_machine(path):
    shown = json.dumps([cell.get("outputs") for cell in json.loads(path.read_text())["cells"]])
    assert not any(
        word in shown for word in ("/tmp", "/work", "/home", "/root", "site-packages", "Traceback", "Warning")
    )


def test_cells_share_their_names_and_show_their_last_value(executed, tmp_path):
    first, second = executed(notebook("print('hello')\nx = 2", "x + 1"), tmp_path)["cells"]
    assert first["outputs"] == [{"name": "stdout", "output_type": "stream", "text": ["hello\n"]}]
    assert second["outputs"][0]["data"] == {"text/plain": ["3"]}
    assert (first["execution_count"], second["execution_count"]) == (1, 2)


def test_cells_work_in_a_folder_of_their_own(executed, tmp_path):
    executed(notebook("open('here', 'w').close()"), tmp_path)
    assert (tmp_path / "here").exists()


def test_a_cell_that_fails_says_which_and_why(executed, tmp_path):
    with pytest.raises(Exception, match=r"cell 2:\n1 / 0\n[\s\S]*ZeroDivisionError"):
        executed(notebook("x = 1", "1 / 0"), tmp_path)
