"""Worlds of somebody else: found by class, file or entry point, and given what they take."""

import json
import sys
from importlib import metadata

import pytest
from caretree.sim.errors import CaretreeError
from caretree.trees.campaign.key import campaign_key
from caretree.trees.cli import main
from caretree.trees.run.open_world import OpenWorld, installed_worlds, world_file
from caretree.trees.run.task import load_task
from caretree.trees.run.worlds import make_world

SOURCE = """
from pathlib import Path
from typing import Annotated, Any, Literal
from caretree.sim.scripted.world import ScriptedWorld
from caretree.trees.run.parameters import Parameter


class Lab(ScriptedWorld):
    def __init__(
        self,
        *,
        seed: int = 0,
        rate: Annotated[float, Parameter("of the servo", unit="Hz", low=1.0, high=500.0)] = 100.0,
        mode: Literal["fast", "slow"] = "fast",
        host: str | None = None,
        site: Path = Path("site.yaml"),
        retries: int = 1,
    ) -> None:
        super().__init__(seed=seed)
        self.given = dict(seed=seed, rate=rate, mode=mode, host=host, site=site, retries=retries)

    def add(self, item):
        raise AssertionError("a task of the tests has no scene")


class Needs(ScriptedWorld):
    def __init__(self, host: str) -> None:
        super().__init__()


class Takes(ScriptedWorld):
    def __init__(self, driver: Any) -> None:
        super().__init__()


class Broken(ScriptedWorld):
    def __init__(self) -> None:
        raise ValueError("no cable")


class NoClock(ScriptedWorld):
    def __init__(self) -> None:
        super().__init__()
        del self.clock


class HalfClock(ScriptedWorld):
    def __init__(self) -> None:
        super().__init__()
        self.clock = 3.0


class NoRoom(ScriptedWorld):
    def __init__(self) -> None:
        super().__init__()
        self.room = None


class Leaves(ScriptedWorld):
    def __init__(self, what: Literal["send", "close"]) -> None:
        super().__init__()
        self.what = what

    def send(self, command):
        if self.what == "send":
            raise SystemExit(3)
        return super().send(command)

    def close(self):
        if self.what == "close":
            raise OSError("the socket is gone")


def three() -> int:
    return 3
"""


@pytest.fixture(autouse=True)
def in_a_folder_with_a_robot(tmp_path, monkeypatch):
    (tmp_path / "lab_robot.py").write_text(SOURCE)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    yield
    sys.modules.pop("lab_robot", None)
    sys.modules.pop("caretree_world_lab_robot", None)


@pytest.mark.parametrize("place", ["lab_robot", "lab_robot.py"])
def test_a_class_is_found_by_its_module_and_by_its_file(place):
    world = OpenWorld(f"{place}:Lab").make(7, {"rate": 50.0})
    assert (world.given["seed"], world.given["rate"], world.given["mode"]) == (7, 50.0, "fast")


def test_an_installed_package_offers_worlds_by_name(monkeypatch):
    offered = metadata.EntryPoint(name="lab", value="lab_robot:Lab", group="caretree.worlds")
    monkeypatch.setattr(metadata, "entry_points", lambda group: [offered] if group == "caretree.worlds" else [])
    assert installed_worlds()["lab"] == "lab_robot:Lab"
    assert {"remote", "ros1"} <= set(installed_worlds())
    assert "lab_robot" not in sys.modules, "nothing is imported until it is asked for"
    world, senses = make_world("lab", load_task("wave"), seed=3, arguments={"retries": 2})
    assert world.given["retries"] == 2
    assert senses is None
    with pytest.raises(CaretreeError, match=r"unknown world 'moon'; .* bullet, scripted, remote, ros1, lab, or give"):
        make_world("moon", load_task("wave"), seed=0)


def test_values_have_the_types_that_the_class_asks_for():
    lab = OpenWorld("lab_robot:Lab")
    read = lab.read(["rate=50", "mode=slow", "host=10", "site=my lab.yaml", "retries=3"])
    assert read == {"rate": 50.0, "mode": "slow", "host": "10", "site": "my lab.yaml", "retries": 3}
    assert isinstance(read["rate"], float)


@pytest.mark.parametrize(
    ("world", "arguments", "said"),
    [
        ("lab_robot:Lab", ["rat=3"], "world lab_robot:Lab takes rate (a number from 1 to 500 Hz), mode (fast or slow)"),
        ("lab_robot:Lab", ["rat=3"], "rate is meant?"),
        ("lab_robot:Lab", ["rate=fast"], "rate is 'fast', but a number from 1 to 500 Hz is asked for"),
        ("lab_robot:Lab", ["rate=1000"], "rate is 1000, but a number from 1 to 500 Hz is asked for"),
        ("lab_robot:Lab", ["mode=quick"], "mode is 'quick', but fast or slow is asked for"),
        ("lab_robot:Lab", ["retries=1.5"], "retries is 1.5, but a whole number is asked for"),
        ("lab_robot:Lab", ["rate=[1"], "'[1' is no value"),
        ("lab_robot:Lab", ["rate"], "NAME=VALUE is asked for"),
        ("lab_robot:Lab", ["seed=3"], "takes rate"),
        ("lab_robot:Needs", [], "needs --world-arg host=, a text"),
        ("lab_robot:Takes", [], "takes driver, which --world-arg cannot give"),
        ("lab_robot:Broken", [], "cannot be made: ValueError: no cable (at lab_robot.py:"),
        ("lab_robot:three", [], "makes a int, but a World is asked for"),
        ("lab_robot:NoClock", [], "has no clock: its `clock` has to have now() and wait_until(time), but is None"),
        ("lab_robot:HalfClock", [], "but is a float without now and wait_until"),
        ("lab_robot:NoRoom", [], "has no map: its `room` has to be a RoomMap, for instance"),
        ("lab_robot:Nobody", [], "has no class Nobody; its worlds are Lab, Needs, Takes, Broken, NoClock"),
        ("lab_robot.py:Nobody", [], "has no class Nobody"),
        ("nowhere:Robot", [], "cannot be loaded: ModuleNotFoundError: No module named 'nowhere'"),
        ("nowhere.py:Robot", [], "there is no file nowhere.py"),
        (":Robot", [], "is not written package.module:Class or file.py:Class"),
        ("ros2", [], "unknown world 'ros2'; there are bullet, scripted, remote, ros1, or give package.module:Class"),
        ("scripted", ["rate=3"], "the scripted world takes no --world-arg"),
        ("bullet", ["rate=3"], "the bullet world takes no --world-arg"),
    ],
)
def test_a_users_mistake_is_one_sentence_and_leaves_nothing_behind(world, arguments, said, tmp_path, capsys):
    given = [part for text in arguments for part in ("--world-arg", text)]
    assert main(["run", "wave", "--world", world, *given]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert told.count("\n") == 1
    assert not list(tmp_path.glob("runs/*"))


def test_what_belongs_to_the_bullet_world_is_refused():
    with pytest.raises(CaretreeError, match="--gown needs the bullet world: lab_robot:Lab brings its own"):
        make_world("lab_robot:Lab", load_task("wave"), seed=0, gown="large")


def test_a_run_says_what_its_world_was_given_and_can_be_repeated(tmp_path, capsys):
    assert main(["run", "wave", "--world", "lab_robot:Lab", "--world-arg", "rate=50", "--out", "r"]) == 0
    run = json.loads((tmp_path / "r/run.json").read_text())
    assert (run["world"], run["parameters"]["world_args"]) == ("lab_robot:Lab", {"rate": 50.0})
    assert main(["replay", "r"]) == 0
    assert "repeats exactly" in capsys.readouterr().out


def test_a_campaign_of_faults_takes_it_too(tmp_path):
    arguments = ["inject", "wave", "--world", "lab_robot.py:Lab", "--world-arg", "rate=50", "--sample", "1"]
    assert main([*arguments, "--seed", "103", "--fault", "occlusion"]) in (0, 1)
    assert (tmp_path / "runs/inject-wave-lab_robot.py_Lab-seed103/inject.jsonl").exists()


def test_a_changed_world_makes_other_trials(tmp_path):
    task, keys = load_task("wave"), []
    for text in (SOURCE, SOURCE + "\n"):
        (tmp_path / "lab_robot.py").write_text(text)
        keys.append(campaign_key(task, (), world="lab_robot:Lab"))
    assert keys[0] != keys[1]
    assert world_file("bullet") is None
    assert world_file("nowhere.at.all:Robot") is None
    assert world_file("nowhere.py:Robot") is None


def test_a_driver_that_ends_the_program_ends_the_run_and_its_record_says_so(tmp_path, capsys):
    given = ["--world", "lab_robot:Leaves", "--world-arg", "what=send", "--out", "r"]
    assert main(["run", "wave", *given]) == 1
    assert "sys.exit(3) was called (at lab_robot.py:" in capsys.readouterr().out
    run = json.loads((tmp_path / "r/run.json").read_text())
    assert run["outcome"] == "safe_stop"
    assert "sys.exit(3) was called" in run["reason"]
    assert (tmp_path / "r/errors.log").exists()


def test_a_world_that_cannot_be_closed_is_told_and_the_outcome_stays(tmp_path, capsys):
    given = ["--world", "lab_robot:Leaves", "--world-arg", "what=close", "--out", "r"]
    assert main(["run", "wave", *given]) == 0
    told = capsys.readouterr()
    assert "success" in told.out
    assert told.err.startswith("caretree: the world could not be closed: the socket is gone (at lab_robot.py:")
    assert told.err.count("\n") == 1
