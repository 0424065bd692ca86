import configparser
import importlib
import re
import sys
from pathlib import Path

import pytest
from caretree.sim.command_line import BAD_INPUT, answered
from caretree.sim.extras import EXTRA_OF, MissingExtra, later, missing_extra, need, put_off

SETUP = Path(__file__).parents[2] / "setup.cfg"
NAMES = {  # as it is imported -> as it is installed, where the two differ
    "PIL": "pillow",
    "coal": "pin",  # brings it
    "cv2": "opencv-python-headless",
    "pinocchio": "pin",
    "pybullet_utils": "pybullet",
    "sklearn": "scikit-learn",
    "yaml": "pyyaml",
    "zmq": "pyzmq",
}


def packages_of(extra):
    config = configparser.ConfigParser()
    config.read(SETUP)
    lines = config["options.extras_require"][extra].split("\n")
    return {re.split(r"[\[=<>~ ;]", line)[0] for line in lines if line and not line.startswith("#")}


@pytest.mark.parametrize("package", EXTRA_OF)
def test_the_extra_that_is_named_brings_the_package(package):
    assert NAMES.get(package, package) in packages_of(EXTRA_OF[package])


def test_nothing_is_imported_before_it_is_used():
    sys.modules.pop("this", None)
    waiting = later("this")
    assert "this" not in sys.modules
    assert repr(waiting)
    assert "this" not in sys.modules


def test_what_is_used_is_the_packages_own():
    fractions = later("fractions")
    assert fractions.Fraction(1, 2) + fractions.Fraction(1, 2) == 1
    assert "Fraction" in vars(fractions), "found at once from then on"


def test_what_another_package_imports_can_wait_until_it_is_used(tmp_path, monkeypatch):
    (tmp_path / "drawing").mkdir()
    (tmp_path / "drawing" / "__init__.py").write_text("")
    (tmp_path / "drawing" / "lines.py").write_text("WIDTH = 3")
    (tmp_path / "planner.py").write_text("import drawing.lines as lines\ndef width(): return lines.WIDTH\n")
    monkeypatch.syspath_prepend(tmp_path)
    for name in ("drawing", "drawing.lines", "planner"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    with put_off("drawing", "lines"):
        planner = importlib.import_module("planner")
    assert "drawing" not in sys.modules
    assert planner.width() == 3, "it has the real one by now"
    assert importlib.import_module("drawing").__file__
    with put_off("drawing", "lines"):
        assert sys.modules["drawing"].__file__, "what is there already stays"


@pytest.fixture
def without_yaml(monkeypatch):
    monkeypatch.setitem(sys.modules, "yaml", None)


def test_a_missing_package_is_told_with_its_extra(without_yaml):
    sentence = r"this needs yaml, which is not installed: pip install 'caretree\[yaml\]'"
    with pytest.raises(MissingExtra, match=sentence):
        _ = later("yaml").safe_load
    with pytest.raises(MissingExtra, match="the site needs yaml"):
        need("yaml", "the site")
    need("fractions")


def test_a_package_that_no_extra_brings_stays_an_import_error(monkeypatch):
    with pytest.raises(ModuleNotFoundError, match="no_such_package"):
        _ = later("no_such_package").anything
    assert missing_extra(ModuleNotFoundError(name="no_such_package")) is None


def import_yaml():
    import yaml

    return len(yaml.__name__)


@pytest.mark.parametrize("command", [import_yaml, lambda: later("yaml").safe_load("1")])
def test_the_command_line_names_the_extra_of_the_command(without_yaml, capsys, command):
    assert answered("caretree", command) == BAD_INPUT
    assert answered("caretree gap", command, extra="gap") == BAD_INPUT
    one, other = capsys.readouterr().err.splitlines()
    assert one == "caretree: this needs yaml, which is not installed: pip install 'caretree[yaml]'"
    assert other == "caretree gap: this needs yaml, which is not installed: pip install 'caretree[gap]'"


def test_a_users_own_missing_module_is_no_matter_of_extras():
    def command():
        import no_such_package

        return no_such_package.status

    with pytest.raises(ModuleNotFoundError):
        answered("caretree", command)
