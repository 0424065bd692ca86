"""The hand-written lists of the package agree with what is on disk."""

import ast
import configparser
import re
import sys
from pathlib import Path

import pytest
from caretree.sim.extras import EXTRA_OF

ROOT = Path(__file__).parents[1]
FOLDERS = ("sim", "perception", "learning", "skills", "trees")


def setup_cfg() -> configparser.ConfigParser:
    config = configparser.ConfigParser()
    config.read(ROOT / "setup.cfg")
    return config


def listed(text: str) -> list[str]:
    return [line.strip() for line in text.splitlines() if line.strip() and not line.strip().startswith("#")]


def name_of(requirement: str) -> str:
    return re.split(r"[\[=<>!~ ;]", requirement)[0].lower().replace("_", "-")


def test_every_package_is_listed_by_hand():
    on_disk = {init.parent.relative_to(ROOT) for folder in FOLDERS for init in (ROOT / folder).rglob("__init__.py")}
    options = setup_cfg()["options"]
    packages = {f"caretree.{'.'.join(path.parts)}": path.as_posix() for path in on_disk}
    packages["caretree"] = "caretree"  # __main__.py alone: the name is shared, so it has no __init__.py
    packages["caretree.gap"] = "caretree/gap"  # what users of the gap workflow import
    assert [path.name for path in (ROOT / "caretree").iterdir() if path.suffix] == ["__main__.py"]
    assert set(listed(options["packages"])) == set(packages)
    places = dict(re.split(r"\s*=\s*", line) for line in listed(options["package_dir"]))
    assert places == packages


def test_texts_that_commands_copy_are_shipped():
    patterns = setup_cfg()["options.package_data"]["caretree.trees"].replace(",", " ").split()
    assert {path.name for pattern in patterns for path in (ROOT / "trees").glob(pattern)} >= {
        path.name for path in (ROOT / "trees/skeleton").iterdir()
    }


@pytest.mark.parametrize("folder", FOLDERS)
def test_every_folder_is_typed(folder):
    assert (ROOT / folder / "py.typed").exists()
    assert "py.typed" in setup_cfg()["options.package_data"][f"caretree.{folder}"]


def asked_by(extra: str) -> list[str]:
    """Requirements of an extra, with those of the extras that it takes in."""
    asked = []
    for requirement in listed(setup_cfg()["options.extras_require"][extra]):
        taken = re.fullmatch(r"caretree\[(.+)\]", requirement)
        asked += [each for name in taken[1].split(",") for each in asked_by(name)] if taken else [requirement]
    return asked


def test_the_core_asks_for_two_packages():
    assert [name_of(each) for each in listed(setup_cfg()["options"]["install_requires"])] == ["numpy", "py-trees"]


def test_whatever_is_imported_is_asked_for():
    """EXTRA_OF says which extra brings a package; tests/sim/test_extras.py holds it against setup.cfg."""
    of_debian = {"genpy"}  # with ROS 1, which `make ros` installs
    known = {"numpy", "py_trees", "caretree", *EXTRA_OF, *of_debian, *sys.stdlib_module_names}
    for path in (file for folder in FOLDERS for file in (ROOT / folder).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [str(node.module)] if isinstance(node, ast.ImportFrom) and not node.level else []
            assert {name.partition(".")[0] for name in names} <= known, f"{path}:{node.lineno}"


def test_every_file_of_the_core_is_there():
    for path in listed((ROOT / "tests/core.txt").read_text()):
        assert (ROOT / path).exists(), path


def test_lock_pins_everything_asked_for():
    options = setup_cfg()
    pins = dict(line.split("==") for line in listed((ROOT / "requirements.lock").read_text()))
    pinned = {name_of(name) for name in pins}
    asked = listed(options["options"]["install_requires"]) + asked_by("dev")
    assert {name_of(requirement) for requirement in asked} <= pinned
    for requirement in asked:
        if "==" in requirement:
            name, version = requirement.split("#")[0].strip().split("==")
            assert {name_of(pin): pins[pin] for pin in pins}[name_of(name)] == version


def test_one_version():
    version = setup_cfg()["metadata"]["version"]
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()
