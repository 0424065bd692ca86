"""The API pages show what authors use, and what is wrong with them is an error."""

import runpy
import sys
import types
import warnings
from pathlib import Path

import pytest

from caretree import skills, trees

SCRIPT = Path(__file__).parents[2] / "docs/build_api.py"


@pytest.fixture
def script():
    """What docs/build_api.py defines."""
    before = {module: dict(vars(module)) for module in (skills, trees)}
    yield runpy.run_path(str(SCRIPT))
    for module, names in before.items():  # what its names stand for is looked up only on first use again
        for name in set(vars(module)) - set(names):
            delattr(module, name)


def test_pages_show_what_is_imported_on_first_use_and_link_to_each_other(script, tmp_path, monkeypatch):
    monkeypatch.setitem(script["build"].__globals__, "FACES", ("caretree.trees", "caretree.trees.guard.limits"))
    assert {path.relative_to(tmp_path).as_posix() for path in script["build"](tmp_path)} == {
        "caretree/trees.html",
        "caretree/trees/guard/limits.html",
        "index.html",
        "search.js",
    }
    text = (tmp_path / "caretree/trees.html").read_text()
    for name in trees.__all__:
        assert f'id="{name}"' in text
    assert "when the body fails" in text
    assert str(tmp_path) not in text


def test_every_module_that_has_a_page_is_there(script):
    for name in script["FACES"]:
        assert script["face"](name).docstring


def test_a_name_that_leads_nowhere_is_an_error(script, monkeypatch):
    module = types.ModuleType("offers_nothing")
    module.__all__ = ["nothing"]  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "offers_nothing", module)
    with pytest.raises(AttributeError, match="nothing"):
        script["face"]("offers_nothing")


def test_a_warning_is_an_error(script, tmp_path, monkeypatch):
    def warns(*unused):
        warnings.warn("something is odd", stacklevel=1)

    monkeypatch.setattr("pdoc.render.html_module", warns)
    with pytest.raises(UserWarning, match="something is odd"):
        script["build"](tmp_path)
